// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/interference.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "volcontact/pair/clip/clip.h"
#include "volcontact/pair/closed_form/half_space_capsule.h"
#include "volcontact/pair/closed_form/half_space_ellipsoid.h"
#include "volcontact/pair/closed_form/half_space_frustum.h"
#include "volcontact/pair/closed_form/half_space_sphere.h"
#include "volcontact/pair/closed_form/half_space_torus.h"
#include "volcontact/pair/closed_form/sphere_sphere.h"
#include "volcontact/pair/mesh_columns/in_round/round_columns.h"
#include "volcontact/pair/mesh_columns/mesh_columns.h"
#include "volcontact/pair/mesh_columns/radial/composed_columns.h"
#include "volcontact/pair/mesh_columns/radial/torus_columns.h"
#include "volcontact/pair/octree/octree.h"
#include "volcontact/pair/overlap_limits.h"
#include "volcontact/pair/sections/bore/composed_sections.h"
#include "volcontact/pair/sections/torus/torus_in_composed.h"
#include "volcontact/pair/sections/torus/torus_sections.h"
#include "volcontact/pair/surface_sweep/surface_sweep.h"
#include "volcontact/pair/torus_pair/torus_pair.h"

namespace volcontact {

struct InterferenceWorkspace::Scratch {
  ClipScratch clip;
  LinesScratch lines;
  ComposedScratch composed;
  RingScratch ring;
  RingPairScratch ring_pair;
  ShellScratch shell;
  ColumnsScratch columns;
  RoundColumnsScratch round_columns;
  TorusColumnsScratch torus_columns;
  ComposedColumnsScratch composed_columns;
  OctreeScratch octree;
};

InterferenceWorkspace::InterferenceWorkspace() : scratch_(std::make_unique<Scratch>()) {}
InterferenceWorkspace::~InterferenceWorkspace() = default;
InterferenceWorkspace::InterferenceWorkspace(InterferenceWorkspace&&) noexcept = default;
InterferenceWorkspace& InterferenceWorkspace::operator=(InterferenceWorkspace&&) noexcept = default;

namespace {

// An engine serves a pair when its function is found by overload for the shapes in this order; the
// other order is then the mirror image.
template <typename A, typename B>
constexpr bool has_closed_form =
    requires(const A& a, const B& b, const Pose& X_AB) { closed_form(a, b, X_AB); };
template <typename A, typename B>
constexpr bool has_clip = requires(const A& a, const B& b, const Pose& X_AB, ClipScratch& scratch) {
  clip(a, b, X_AB, scratch);
};
template <typename A, typename B>
constexpr bool has_lines = HasFaces<A> && HasFaces<B> && (HasRoundFaces<A> || HasRoundFaces<B>);
template <typename A, typename B>
constexpr bool has_ring = std::is_same_v<A, Torus> && HasFaces<B> && !std::is_same_v<B, HalfSpace>;
template <typename A, typename B>
constexpr bool both_rings = std::is_same_v<A, Torus> && std::is_same_v<B, Torus>;
template <typename S>
constexpr bool is_composed = std::is_same_v<S, Csg>;
template <typename A, typename B>
constexpr bool has_ring_composed = std::is_same_v<A, Torus> && is_composed<B>;
template <typename A, typename B>
constexpr bool has_composed_lines =
    (is_composed<A> && (is_composed<B> || HasFaces<B>)) || (HasFaces<A> && is_composed<B>);
template <typename S>
constexpr bool is_mesh = std::is_same_v<S, Mesh>;
// Columns for composed solids serve every surface of triangles, lines only few faces in a bore.
template <typename A, typename B>
constexpr bool has_composed_columns = HasTriangles<A> && is_composed<B>;
// Columns come first then, and lines where they do not reach.
template <typename A, typename B>
constexpr bool prefers_columns = (std::is_same_v<A, ConvexPolytope> && is_composed<B>) ||
                                 (is_composed<A> && std::is_same_v<B, ConvexPolytope>);
template <typename A, typename B>
constexpr bool has_columns =
    has_composed_columns<A, B> || (is_mesh<A> && (HasTriangles<B> || std::is_same_v<B, HalfSpace> ||
                                                  HasRoundFaces<B> || std::is_same_v<B, Torus>));
template <typename A, typename B>
constexpr bool both_unbounded = std::is_same_v<A, HalfSpace> && std::is_same_v<B, HalfSpace>;

template <typename A, typename B>
constexpr bool serves_pair(Engine engine) {
  switch (engine) {
    case Engine::kAuto:
      return true;
    case Engine::kClosedForm:
      return has_closed_form<A, B> || has_closed_form<B, A>;
    case Engine::kClip:
      return has_clip<A, B> || has_clip<B, A>;
    case Engine::kLines:
      return has_lines<A, B> || has_composed_lines<A, B> || has_ring<A, B> || has_ring<B, A> ||
             both_rings<A, B> || has_ring_composed<A, B> || has_ring_composed<B, A>;
    case Engine::kColumns:
      return has_columns<A, B> || has_columns<B, A>;
    case Engine::kOctree:
      return !both_unbounded<A, B>;
  }
  return false;
}

// Not every composed solid can be written as the pieces that columns need.
template <typename A, typename B>
bool serves_pair(Engine engine, const A& a, const B& b) {
  if constexpr (has_composed_columns<A, B>) {
    if (engine == Engine::kColumns) return has_columns_pieces(b);
  }
  if constexpr (has_composed_columns<B, A>) {
    if (engine == Engine::kColumns) return has_columns_pieces(a);
  }
  return serves_pair<A, B>(engine);
}

template <typename A, typename B>
Engine engine_for_pair(const A& a, const B& b) {
  if constexpr (prefers_columns<A, B>) {
    if (serves_pair(Engine::kColumns, a, b)) return Engine::kColumns;
  }
  for (Engine engine :
       {Engine::kClosedForm, Engine::kClip, Engine::kLines, Engine::kColumns, Engine::kOctree}) {
    if (serves_pair(engine, a, b)) return engine;
  }
  return Engine::kAuto;
}

// Metrics of B's pair with A, from a function made for (B, A).
template <typename Function>
VolumeMetrics mirror(const Pose& X_AB, Function&& metrics_in_B) {
  VolumeMetrics metrics_B = metrics_in_B(X_AB.inverse());
  if (!metrics_B.touching()) return metrics_B;
  return reversed(transformed(metrics_B, X_AB));
}

template <typename A, typename B>
VolumeMetrics closed_form_metrics(const A& a, const B& b, const Pose& X_AB) {
  if constexpr (has_closed_form<A, B>) {
    return closed_form(a, b, X_AB);
  } else {
    return mirror(X_AB, [&](const Pose& X_BA) { return closed_form(b, a, X_BA); });
  }
}

template <typename A, typename B>
VolumeMetrics clip_metrics(const A& a, const B& b, const Pose& X_AB, ClipScratch& scratch) {
  if constexpr (has_clip<A, B>) {
    return clip(a, b, X_AB, scratch);
  } else {
    return mirror(X_AB, [&](const Pose& X_BA) { return clip(b, a, X_BA, scratch); });
  }
}

// Turns metrics made for (B, A) into those of (A, B).
void mirror_sites(const Pose& X_AB, Interference& out) {
  const auto mirrored = [&](const VolumeMetrics& metrics_B) {
    return metrics_B.touching() ? reversed(transformed(metrics_B, X_AB)) : metrics_B;
  };
  out.total = mirrored(out.total);
  for (VolumeMetrics& site : out.sites) site = mirrored(site);
}

// By columns through the overlap. False when the solids or the pose are beyond that.
template <typename A, typename B>
bool inner_lines(const A& a, const B& b, const Pose& X_AB, const InterferenceOptions& options,
                 InterferenceWorkspace::Scratch& scratch, Interference& out) {
  if constexpr (has_lines<A, B>) {
    return lines_interference(ConvexView(a), ConvexView(b), X_AB, options, scratch.lines, out);
  } else if constexpr (both_rings<A, B>) {
    return ring_pair(a, b, X_AB, options, scratch.ring_pair, out);
  } else if constexpr (has_ring_composed<A, B>) {
    if (!has_lines_pieces(b)) return false;
    scratch.composed.pieces[1].clear();
    add_lines_pieces(b, scratch.composed.pieces[1]);
    return ring_composed(a, X_AB, options, scratch.ring, scratch.composed, out);
  } else if constexpr (has_ring<A, B>) {
    return ring_interference(a, ConvexView(b), X_AB, options, scratch.ring,
                             scratch.composed.regions, out);
  } else if constexpr (has_ring_composed<B, A> || has_ring<B, A>) {
    if (!inner_lines(b, a, X_AB.inverse(), options, scratch, out)) return false;
    mirror_sites(X_AB, out);
    return true;
  } else {
    if (!has_lines_pieces(a) || !has_lines_pieces(b)) return false;
    for (auto& pieces : scratch.composed.pieces) pieces.clear();
    add_lines_pieces(a, scratch.composed.pieces[0]);
    add_lines_pieces(b, scratch.composed.pieces[1]);
    return composed_lines(X_AB, options, scratch.lines, scratch.composed, out);
  }
}

// Whether the numbers of the sites and their sum can be those of an overlap. Each site is looked
// at: wrong ones may cancel.
template <typename A, typename B>
bool are_possible(const A& a, const B& b, const Pose& X_AB, const Interference& out) {
  if (out.sites.empty()) return !out.total.touching() && is_finite(out.total);
  const OverlapLimits limits_a = limits_of(a), limits_b = limits_of(b);
  const auto possible = [&](const VolumeMetrics& metrics) {
    return is_possible(metrics, limits_a, limits_b, X_AB);
  };
  return possible(out.total) &&
         (out.sites.size() == 1 || std::all_of(out.sites.begin(), out.sites.end(), possible));
}

// Of every site and of their sum; see bound_depth_moment.
template <typename A, typename B>
void bound_depth_moments(const A& a, const B& b, Interference& out) {
  const double longest = longest_line(limits_of(a), limits_of(b));
  double sum = 0.0;
  for (VolumeMetrics& site : out.sites) {
    bound_depth_moment(longest, site);
    sum += site.depth_moment;
  }
  out.total.depth_moment = sum;
}

// The same, or else by the surface of the overlap. False when that fails as well.
template <typename A, typename B>
bool lines(const A& a, const B& b, const Shape& shape_a, const Shape& shape_b, const Pose& X_AB,
           const InterferenceOptions& options, InterferenceWorkspace::Scratch& scratch,
           Interference& out) {
  if (inner_lines(a, b, X_AB, options, scratch, out) && are_possible(a, b, X_AB, out)) return true;
  return shell_interference(shape_a, shape_b, X_AB, options, scratch.shell, out) &&
         are_possible(a, b, X_AB, out);
}

// False when the pose is beyond the engine.
template <typename A, typename B>
bool columns(const A& a, const B& b, const Pose& X_AB, const InterferenceOptions& options,
             InterferenceWorkspace::Scratch& scratch, Interference& out) {
  if constexpr (has_columns<A, B>) {
    const SurfaceView surface_a = surface_of(a, scratch.columns.store[0]);
    if constexpr (is_composed<B>) {
      return composed_columns(surface_a, b, X_AB, options, scratch.columns, scratch.round_columns,
                              scratch.composed_columns, out);
    } else if constexpr (HasTriangles<B>) {
      columns_interference(surface_a, surface_of(b, scratch.columns.store[1]), X_AB, options,
                           scratch.columns, out);
    } else if constexpr (HasRoundFaces<B>) {
      return round_columns(surface_a, ConvexView(b), X_AB, options, scratch.round_columns, out);
    } else if constexpr (std::is_same_v<B, Torus>) {
      return torus_columns(surface_a, b, X_AB, options, scratch.torus_columns, out);
    } else {
      columns_interference(surface_a, b, X_AB, options, scratch.columns, out);
    }
    return true;
  } else {
    if (!columns(b, a, X_AB.inverse(), options, scratch, out)) return false;
    mirror_sites(X_AB, out);
    return true;
  }
}

// `out.total` as the only site.
void set_one_site(Interference& out) {
  out.sites.resize(out.total.touching() ? 1 : 0);
  if (out.total.touching()) out.sites[0] = out.total;
}

void set_status(Status status, Interference& out) {
  out.total = VolumeMetrics{};
  out.total.status = status;
  out.sites.clear();
}

}  // namespace

bool serves(Engine engine, const Shape& a, const Shape& b) {
  return std::visit([=](const auto& solid_a,
                        const auto& solid_b) { return serves_pair(engine, solid_a, solid_b); },
                    a, b);
}

Engine engine_for(const Shape& a, const Shape& b) {
  return std::visit(
      [](const auto& solid_a, const auto& solid_b) { return engine_for_pair(solid_a, solid_b); }, a,
      b);
}

void interference(const Shape& a, const Shape& b, const Pose& X_AB,
                  const InterferenceOptions& options, InterferenceWorkspace& workspace,
                  Interference& out) noexcept {
  const auto run = [&](const auto& solid_a, const auto& solid_b) {
    using A = std::decay_t<decltype(solid_a)>;
    using B = std::decay_t<decltype(solid_b)>;
    const bool wanted =
        options.engine != Engine::kAuto && serves_pair(options.engine, solid_a, solid_b);
    out.engine = wanted ? options.engine : engine_for_pair(solid_a, solid_b);
    if (!X_AB.is_finite()) return set_status(Status::kInvalid, out);
    if constexpr (both_unbounded<A, B>) return set_status(Status::kUnbounded, out);
    const auto possible = [&] { return are_possible(solid_a, solid_b, X_AB, out); };
    // Whether there is nothing left to do: from what is no number nothing better follows.
    const auto settled = [&] {
      if (is_finite(out.total)) return possible();
      set_status(Status::kInvalid, out);
      return true;
    };
    if constexpr (serves_pair<A, B>(Engine::kClosedForm)) {
      if (out.engine == Engine::kClosedForm) {
        out.total = closed_form_metrics(solid_a, solid_b, X_AB);
        set_one_site(out);
        // One formula gives all the numbers, in the time that it takes to look at them: V tells.
        if (!std::isfinite(out.total.volume)) return set_status(Status::kInvalid, out);
        if (is_possible_volume(out.total, limits_of(solid_a), limits_of(solid_b))) return;
        out.engine = Engine::kOctree;
      }
    }
    if constexpr (serves_pair<A, B>(Engine::kClip)) {
      if (out.engine == Engine::kClip) {
        out.total = clip_metrics(solid_a, solid_b, X_AB, workspace.scratch().clip);
        set_one_site(out);
        if (settled()) return;
        out.engine = Engine::kOctree;
      }
    }
    if constexpr (prefers_columns<A, B>) {
      if (out.engine == Engine::kColumns && !wanted) {
        if (columns(solid_a, solid_b, X_AB, options, workspace.scratch(), out) && possible() &&
            out.total.status != Status::kApproximate) {
          return;
        }
        out.engine = Engine::kLines;
      }
    }
    if constexpr (serves_pair<A, B>(Engine::kLines)) {
      if (out.engine == Engine::kLines) {
        if (lines(solid_a, solid_b, a, b, X_AB, options, workspace.scratch(), out)) return;
        out.engine = Engine::kOctree;
      }
    }
    if constexpr (serves_pair<A, B>(Engine::kColumns)) {
      if (out.engine == Engine::kColumns) {
        if (columns(solid_a, solid_b, X_AB, options, workspace.scratch(), out) && settled()) return;
        out.engine = Engine::kOctree;
      }
    }
    octree_interference(a, b, X_AB, options, workspace.scratch().octree, out);
    if (!possible()) set_status(Status::kInvalid, out);
  };
  std::visit(
      [&](const auto& solid_a, const auto& solid_b) {
        run(solid_a, solid_b);
        if (out.engine != Engine::kClosedForm) bound_depth_moments(solid_a, solid_b, out);
      },
      a, b);
}

}  // namespace volcontact
