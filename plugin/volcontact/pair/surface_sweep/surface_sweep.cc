// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/surface_sweep.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>

#include "volcontact/pair/surface_sweep/face_edge.h"
#include "volcontact/pair/surface_sweep/sweep_depth.h"

namespace volcontact {
namespace {

constexpr double kMargin = 0.02;                   // of the box around what the window leaves
constexpr double kTargets[] = {1e-4, 1e-6, 1e-8};  // of a flux, relative
constexpr double kGood = 1e-4;        // error of V at which the first target will do, relative
constexpr double kWorst = 1e-3;       // error of V with which an answer is one, relative
constexpr double kSamePlace = 1e-6;   // of the box: two ends in one place
constexpr int kRounds = 4;            // of looking at curves that neighbours tell of
constexpr double kSpeck = 1e-10;      // of V: a region that is none
constexpr double kContained = 1e-6;   // of V: all of a solid
constexpr double kBesideEdge = 1e-5;  // of the box: how far from an edge to look for surface
constexpr double kNarrowExit = 1.0;   // [rad], about the turn by the first curves of a ring, twice
constexpr double kDoubt = 5.0;  // error of V by how far the surface is from closed, as measured

class SweepRun {
 public:
  SweepRun(const Shape& a, const Shape& b, const Pose& X_AB, const InterferenceOptions& options,
           SurfaceSweepScratch& s, Interference& out)
      : options_(options), s_(s), out_(out), views_{view_of(a), view_of(b)} {
    shapes_[0] = &a;
    shapes_[1] = &b;
    X_AB_ = X_AB;
  }

  bool run() {
    out_.total = VolumeMetrics{};
    out_.sites.clear();
    for (const SolidView& view : views_) {
      if (view.own.volume == 0.0 && view.own.volume_error == 0.0) return true;
    }
    window_ = find_window(views_[0], views_[1], X_AB_, s_.hull, s_.part);
    if (window_.apart) return true;
    Vec3 half = Vec3::Zero();
    for (const Vec3& p : s_.hull.points()) half = half.cwiseMax(p.cwiseAbs());
    half = (1.0 + kMargin) * half + Vec3::Constant(kMargin * kMargin * half.maxCoeff());
    const Pose X_WA = window_.X_AW.inverse();
    if (!s_.solids.read(*shapes_[0], X_WA, *shapes_[1], X_WA * X_AB_, half)) return false;
    if (!make_families()) return false;
    hint_at_exits();
    bool looked = views_[0].convex && views_[1].convex;  // they have one region
    for (const double target : kTargets) {
      if (!sweep(target)) return false;
      if (!looked && look_closer() && !sweep(target)) return false;
      looked = true;
      find_regions();
      if (!(volume_ > 0.0)) return false;
      if (error_ <= kGood * volume_) break;
    }
    if (!(error_ <= std::min(kWorst, options_.tolerance) * volume_)) return false;
    write_sites();
    return is_finite(out_.total);
  }

 private:
  using ScratchRegion = SurfaceSweepScratch::Region;

  bool make_families() {
    const std::vector<SweepFace>& faces = s_.solids.faces;
    const auto count = static_cast<int>(faces.size());
    s_.families.clear();
    s_.families.reserve(faces.size());
    s_.family_of.assign(faces.size(), -1);
    for (int f = 0; f < count; ++f) {
      if (faces[f].twin != f) continue;
      bool surface = false;
      for (int g = f; g < count; ++g) surface |= faces[g].twin == f && !faces[g].seam;
      if (!surface) continue;
      const CurveFamily family(faces[f], s_.solids.half);
      if (family.empty()) continue;
      s_.family_of[f] = static_cast<int>(s_.families.size());
      s_.families.push_back(family);
    }
    if (s_.patches.size() < s_.families.size()) s_.patches.resize(s_.families.size());
    for (SweepPatch& patch : s_.patches) {
      patch.hints.clear();
      patch.swept = false;
    }
    return !s_.families.empty();
  }

  bool sweep(double target) {
    for (SweepPatch& patch : s_.patches) patch.stale = true;
    for (int round = 0; round < kRounds; ++round) {
      s_.surface.clear();
      const auto count = static_cast<int>(s_.family_of.size());
      for (int f = 0; f < count; ++f) {
        const int k = s_.family_of[f];
        if (k < 0) continue;
        SweepPatch& patch = s_.patches[k];
        if (patch.stale) {
          if (!sweep_face(s_.solids, f, s_.families[k], target, s_.patch, patch)) return false;
          patch.stale = false;
        }
        patch.base = static_cast<int>(s_.surface.strips.size());
        s_.surface.append(patch.surface);
      }
      const auto strips = static_cast<int>(s_.surface.strips.size());
      for (int i = 0; i < strips; ++i) s_.surface.strips[i].site = i;
      if (!join_strips()) break;
    }
    return true;
  }

  // ---- Which strips hang together ----

  int root(int strip) const {
    while (s_.surface.strips[strip].site != strip) strip = s_.surface.strips[strip].site;
    return strip;
  }
  void join(int one, int other) {
    const int a = root(one), b = root(other);
    s_.surface.strips[std::max(a, b)].site = std::min(a, b);
  }

  // True when a neighbour tells of a curve that has not been looked at.
  bool join_strips() {
    bool more = false;
    const auto count = static_cast<int>(s_.family_of.size());
    for (int f = 0; f < count; ++f) {
      if (s_.family_of[f] < 0) continue;
      join_stretches(f);
      const SweepPatch& patch = s_.patches[s_.family_of[f]];
      for (const SweepStretch& stretch : patch.stretches) {
        const int first = patch.base + stretch.first;
        for (int i = first; i < first + stretch.count; ++i) {
          const SweepStrip& strip = s_.surface.strips[i];
          more |= join_across(i, strip.low, strip.at_low);
          more |= join_across(i, strip.high, strip.at_high);
        }
      }
    }
    return more;
  }

  // Stretches next to each other, where their curves have a part in common.
  void join_stretches(int f) {
    const int k = s_.family_of[f];
    const CurveFamily& family = s_.families[k];
    const std::vector<SweepStretch>& all = s_.patches[k].stretches;
    const int base = s_.patches[k].base;
    const double beside = 1e-9 * (family.high() - family.low());
    const auto join_two = [&](const SweepStretch& a, const SweepStretch& b) {
      if (a.count == 0 || b.count == 0) return;
      find_spans(s_.solids, family.curve(a.high - beside), f, s_.patch.curve, spans_);
      find_spans(s_.solids, family.curve(b.low + beside), f, s_.patch.curve, other_);
      if (spans_.count != a.count || other_.count != b.count) return;
      for (int i = 0; i < spans_.count; ++i) {
        for (int j = 0; j < other_.count; ++j) {
          if (meet(spans_.span[i], other_.span[j])) join(base + a.first + i, base + b.first + j);
        }
      }
    };
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      if (all[i + 1].low - all[i].high < beside) join_two(all[i], all[i + 1]);
    }
    if (family.turn() && all.size() > 1) join_two(all.back(), all.front());
    for (const SweepStretch& stretch : all) {  // where only the owner changes, or a circle closes
      if (stretch.count < 2) continue;
      find_spans(s_.solids, family.curve(0.5 * (stretch.low + stretch.high)), f, s_.patch.curve,
                 spans_);
      if (spans_.count == stretch.count && spans_.is_rest()) {
        join(base + stretch.first, base + stretch.first + stretch.count - 1);
      }
      for (int i = 0; i + 1 < std::min(spans_.count, stretch.count); ++i) {
        const double gap = spans_.span[i + 1].low.t - spans_.span[i].high.t;
        if (gap <= 1e-9 * (1.0 + std::abs(spans_.span[i].high.t))) {
          join(base + stretch.first + i, base + stretch.first + i + 1);
        }
      }
    }
  }

  static bool meet(const SweepSpans::Span& a, const SweepSpans::Span& b) {
    return std::max(a.low.t, b.low.t) < std::min(a.high.t, b.high.t);
  }

  bool join_across(int strip, const SweepEnd& end, const Vec3& x) {
    bool joined = false;
    for (const int face : {end.face, end.also}) {
      if (face < 0 || joined) continue;
      if (join_face(strip, s_.solids.faces[face].twin, x, joined)) return true;
    }
    if (joined || end.face < 0 || !s_.solids.faces[end.face].seam) return false;
    const auto count = static_cast<int>(s_.solids.faces.size());
    for (int f = 0; f < count && !joined; ++f) {
      if (s_.solids.faces[f].seam || s_.solids.faces[f].smooth != end.smooth) continue;
      if (std::abs(s_.solids.faces[f].value(x)) > kSamePlace) continue;
      if (join_face(strip, s_.solids.faces[f].twin, x, joined)) return true;
    }
    return false;
  }

  bool join_face(int strip, int g, const Vec3& x, bool& joined) {
    const int k = s_.family_of[g];
    if (k < 0) return false;
    const CurveFamily& family = s_.families[k];
    double u, t;
    family.locate(x, u, t);
    // Where the edge runs along a curve of the other face, its surface begins beside it.
    const double beside = kSamePlace * (family.high() - family.low());
    for (const double place : {u, u - beside, u + beside}) {
      if (!(place > family.low() && place < family.high())) continue;
      const int span = span_at(g, family, place, t);
      if (span < 0) continue;
      for (const SweepStretch& stretch : s_.patches[k].stretches) {
        if (place < stretch.low || place > stretch.high) continue;
        if (stretch.count == spans_.count) {
          join(strip, s_.patches[k].base + stretch.first + span);
          joined = true;
          return false;
        }
        std::vector<double>& hints = s_.patches[k].hints;
        if (std::find(hints.begin(), hints.end(), place) != hints.end()) return false;
        hints.push_back(place);
        s_.patches[k].stale = true;
        s_.patches[k].swept = false;
        return true;
      }
    }
    return false;
  }

  // A region may be so small that the first curves miss it in all its faces. True when there is
  // surface that has not been looked at.
  bool look_closer() {
    const bool along_edges = look_along_edges();
    return look_along_rings() || along_edges;
  }

  // Most regions have an edge in a plane.
  bool look_along_edges() {
    const auto count = static_cast<int>(s_.family_of.size());
    const double beside = kBesideEdge * s_.solids.half.norm();
    bool more = false;
    for (int f = 0; f < count; ++f) {
      if (s_.family_of[f] < 0 || s_.solids.faces[f].kind != SweepFace::Kind::kPlane) continue;
      for (int g = 0; g < count; ++g) {
        const SweepFace& other = s_.solids.faces[g];
        if (g == f || other.twin != g) continue;
        if (g < f && other.kind == SweepFace::Kind::kPlane) continue;  // its curves tell as much
        FaceCurve curves[2];
        if (!curves_beside_edge(s_.solids.faces[f], other, beside, curves)) continue;
        for (const FaceCurve& curve : curves) {
          if (!curve.circle && !meets_box(curve, s_.solids.half)) continue;
          find_spans(s_.solids, curve, f, s_.patch.curve, other_);
          for (int i = 0; i < other_.count; ++i) {
            const SweepSpans::Span& span = other_.span[i];
            more |= is_new(f, curve.at(0.5 * (span.low.t + span.high.t)));
          }
        }
      }
    }
    return more;
  }

  // Every ring with every bounded convex piece of the other solid, with the pose of the piece in
  // the frame of the ring.
  template <typename Use>
  void each_ring(Use&& use) {
    for (int ring = 0; ring < 2; ++ring) {
      const auto* torus = std::get_if<Torus>(shapes_[ring]);
      if (!torus) continue;
      s_.pieces.clear();
      std::visit(
          [&](const auto& solid) {
            using S = std::decay_t<decltype(solid)>;
            if constexpr (HasFaces<S> || std::is_same_v<S, Csg>) {
              if (has_lines_pieces(solid)) add_lines_pieces(solid, s_.pieces);
            }
          },
          *shapes_[1 - ring]);
      const Pose X_TO = ring == 0 ? X_AB_ : X_AB_.inverse();
      for (const LinesPiece& piece : s_.pieces) {
        if (piece.body.bounded()) use(ring, *torus, piece, X_TO * piece.X_SB);
      }
    }
  }

  // Calls use(face, family, u) for the curve about a place of the circle of a ring.
  template <typename Use>
  void each_curve_about(int ring, double radius, double angle, Use&& use) {
    const Vec3 x_T(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    const Vec3 x = window_.X_AW.inverse() * (ring == 0 ? x_T : X_AB_ * x_T);
    const auto count = static_cast<int>(s_.family_of.size());
    for (int f = 0; f < count; ++f) {
      const SweepFace& face = s_.solids.faces[f];
      if (s_.family_of[f] < 0 || face.kind != SweepFace::Kind::kTorus) continue;
      if (index(face.owner) != ring) continue;
      const CurveFamily& family = s_.families[s_.family_of[f]];
      double u, t;
      family.locate(x, u, t);
      use(f, family, u);
    }
  }

  // A thin ring may stand out of a round wall between two of its curves.
  void hint_at_exits() {
    each_ring([&](int ring, const Torus& torus, const LinesPiece& piece, const Pose& X_TB) {
      const double R = torus.major_radius(), r = torus.minor_radius();
      s_.faces.clear();
      FaceWriter writer(s_.faces, X_TB, Owner::kB);
      piece.body.write_faces(writer);
      find_torus_exits(s_.faces, R, r, s_.exits);
      for (const TorusExit& exit : s_.exits) {
        if (exit.width() > kNarrowExit) continue;
        each_curve_about(ring, R, exit.middle(), [&](int f, const CurveFamily&, double u) {
          s_.patches[s_.family_of[f]].hints.push_back(u);
        });
      }
    });
  }

  // It may go through a thin plate between two of its curves.
  bool look_along_rings() {
    bool more = false;
    each_ring([&](int ring, const Torus& torus, const LinesPiece& piece, const Pose& X_TB) {
      const double R = torus.major_radius();
      find_torus_arcs(piece.body, X_TB, R, torus.minor_radius(), s_.arcs);
      for (const double angle : s_.arcs.met) {
        each_curve_about(ring, R, angle, [&](int f, const CurveFamily& family, double u) {
          find_spans(s_.solids, family.curve(u), f, s_.patch.curve, spans_);
          more |= spans_.count > 0 && is_new_curve(f, u);
        });
      }
    });
    return more;
  }

  static bool meets_box(const FaceCurve& line, const Vec3& half) {
    double low = -kInfinity, high = kInfinity;
    for (int i = 0; i < 3; ++i) {
      const double to_middle = -line.p[i] / line.u[i], way = std::abs(half[i] / line.u[i]);
      low = std::max(low, to_middle - way);
      high = std::min(high, to_middle + way);
    }
    return !(low > high);
  }

  // Whether there is surface at a place of a face on a curve that was not known to have it.
  bool is_new(int f, const Vec3& x) {
    const int k = s_.family_of[f];
    const CurveFamily& family = s_.families[k];
    double u, t;
    family.locate(x, u, t);
    return span_at(f, family, u, t) >= 0 && is_new_curve(f, u);
  }
  bool is_new_curve(int f, double u) {
    SweepPatch& patch = s_.patches[s_.family_of[f]];
    for (const SweepStretch& stretch : patch.stretches) {
      if (u >= stretch.low && u <= stretch.high && stretch.count == spans_.count) return false;
    }
    patch.hints.push_back(u);
    patch.swept = false;
    return true;
  }

  // Which stretch of a curve (in spans_) reaches to t; -1 for none.
  int span_at(int face, const CurveFamily& family, double u, double t) {
    const FaceCurve curve = family.curve(u);
    find_spans(s_.solids, curve, face, s_.patch.curve, spans_);
    if (curve.circle && t < 0.0) t += 2.0 * kPi;
    const double slack = kSamePlace * s_.solids.half.norm() / curve.u.norm();
    for (int i = 0; i < spans_.count; ++i) {
      if (t >= spans_.span[i].low.t - slack && t <= spans_.span[i].high.t + slack) return i;
    }
    return -1;
  }

  // ---- Regions ----

  void find_regions() {
    s_.regions.clear();
    const auto strips = static_cast<int>(s_.surface.strips.size());
    for (int i = 0; i < strips; ++i) {
      const SweepStrip& strip = s_.surface.strips[i];
      ScratchRegion& region = region_of(root(i));
      region.flux[index(strip.owner)] += strip.flux;
      region.error += strip.error;
    }
    volume_ = error_ = 0.0;
    SweepFlux all;
    int largest = 0;
    const auto count = static_cast<int>(s_.regions.size());
    for (int i = 0; i < count; ++i) {
      all += s_.regions[i].flux[0];
      all += s_.regions[i].flux[1];
      if (volume_of(s_.regions[i]) > volume_of(s_.regions[largest])) largest = i;
    }
    volume_ = all.moment.trace() / 3.0;
    // Cavities and specks are no regions of their own, nor is a surface with a gap.
    bool any_open = false;
    for (int i = 0; i < count; ++i) {
      ScratchRegion& region = s_.regions[i];
      const double volume = volume_of(region);
      region.into = i;
      region.open = error_of(region) > kWorst * volume;
      region.part = i != largest && (volume < kSpeck * volume_ || region.open);
      any_open |= region.part && region.open;
    }
    if (any_open) join_open();
    for (int i = 0; i < count; ++i) {
      if (s_.regions[i].part) merge(i, largest);
    }
    for (const ScratchRegion& region : s_.regions) {
      if (region.into == &region - s_.regions.data()) error_ += error_of(region);
    }
  }

  // Regions with gaps are parts of one that was not seen to hang together, next to each other. Far
  // from the middle of the box a gap by rounding looks larger than it is.
  void join_open() {
    for (ScratchRegion& region : s_.regions) region.box = Aabb::none();
    const auto add = [&](int strip, const Vec3& x) { region_of(root(strip)).box.add(x); };
    for (const SweepPlace& place : s_.surface.places) add(place.strip, place.x);
    for (const SweepTip& tip : s_.surface.tips) add(tip.strip, tip.x);
    const auto count = static_cast<int>(s_.regions.size());
    for (int joined = 0; joined < count; ++joined) {
      for (ScratchRegion& region : s_.regions) {
        region.open = region.open && has_gap(region);
        region.part = region.part && (region.open || volume_of(region) < kSpeck * volume_);
      }
      int one = -1, other = -1;
      double least = kInfinity;
      for (int i = 0; i < count; ++i) {
        for (int k = i + 1; k < count && s_.regions[i].is_open(i); ++k) {
          if (!s_.regions[k].is_open(k)) continue;
          const double way = s_.regions[i].box.distance(s_.regions[k].box);
          if (way < least) {
            least = way;
            one = i;
            other = k;
          }
        }
      }
      if (one < 0) return;
      if (s_.regions[other].part) std::swap(one, other);
      merge(one, other);
    }
  }

  // The same as error_of(), about the middle of the region.
  bool has_gap(const ScratchRegion& region) const {
    const Vec3 gap = region.flux[0].normal + region.flux[1].normal;
    const Mat3 moment =
        region.flux[0].moment + region.flux[1].moment - outer(region.box.center(), gap);
    const double volume = moment.trace() / 3.0;
    const double open = (moment - volume * Mat3::Identity()).cwiseAbs().maxCoeff();
    return open + gap.norm() * region.box.half_sizes().norm() + region.error > kWorst * volume;
  }

  void merge(int part, int whole) {
    ScratchRegion &from = s_.regions[part], &to = s_.regions[whole];
    for (ScratchRegion& region : s_.regions) {
      if (region.into == part) region.into = whole;
    }
    for (int k = 0; k < 2; ++k) to.flux[k] += from.flux[k];
    to.error += from.error;
    to.box.add(from.box);
    from.part = false;
  }

  ScratchRegion& region_of(int root) {
    for (ScratchRegion& region : s_.regions) {
      if (region.root == root) return region;
    }
    s_.regions.emplace_back();
    s_.regions.back().root = root;
    return s_.regions.back();
  }
  static double volume_of(const ScratchRegion& region) {
    return (region.flux[0].moment.trace() + region.flux[1].moment.trace()) / 3.0;
  }
  // How far from closed the surface is.
  double error_of(const ScratchRegion& region) const {
    const Mat3 moment = region.flux[0].moment + region.flux[1].moment;
    const double volume = moment.trace() / 3.0;
    const double open = (moment - volume * Mat3::Identity()).cwiseAbs().maxCoeff();
    const double gap = (region.flux[0].normal + region.flux[1].normal).norm();
    return open + gap * s_.solids.half.norm() + region.error;
  }

  void write_sites() {
    const auto count = static_cast<int>(s_.regions.size());
    for (int i = 0; i < count; ++i) {
      if (s_.regions[i].into != i) continue;
      out_.sites.push_back(transformed(metrics_of(i), window_.X_AW));
    }
    out_.total = out_.sites[0];
    for (std::size_t i = 1; i < out_.sites.size(); ++i) out_.total = out_.total + out_.sites[i];
    if (out_.total.status == Status::kContained && out_.total.area > 0.0 &&
        out_.total.counter_area > 0.0) {
      out_.total.status = Status::kOk;
    }
  }

  VolumeMetrics metrics_of(int i) {
    const ScratchRegion& region = s_.regions[i];
    const SweepFlux &a = region.flux[0], &b = region.flux[1];
    MomentSum sum;
    sum.volume = volume_of(region);
    sum.first = a.first + b.first;
    sum.second = a.second + b.second;
    // The error of a vector goes with its area, and a small area bounds what it can be.
    const double square_a = a.area * a.area, square_b = b.area * b.area;
    const double share_b = square_a + square_b > 0.0 ? square_a / (square_a + square_b) : 0.5;
    sum.area_vector = (1.0 - share_b) * a.normal - share_b * b.normal;
    const Mat3 turn = (1.0 - share_b) * a.moment - share_b * b.moment;
    sum.area_moment =
        Vec3(turn(1, 2) - turn(2, 1), turn(2, 0) - turn(0, 2), turn(0, 1) - turn(1, 0));
    sum.area = a.area;
    sum.counter_area = b.area;
    VolumeMetrics metrics = sum.metrics();
    metrics.volume_error = kDoubt * error_of(region);
    if (a.area == 0.0 || b.area == 0.0) return contained(metrics, a.area == 0.0 ? 1 : 0);
    const auto of_region = [&](int strip) {
      const int at = root(strip);
      for (const ScratchRegion& other : s_.regions) {
        if (other.root == at) return other.into == i;
      }
      return false;
    };
    add_sweep_depth(s_.solids, s_.families, s_.family_of, s_.surface, of_region, s_.patch.curve,
                    views_[0].convex && views_[1].convex, metrics);
    return metrics;
  }

  // No surface of the other solid: there is no direction.
  VolumeMetrics contained(VolumeMetrics metrics, int inner) const {
    const VolumeMetrics& own = views_[inner].own;
    if (own.status == Status::kOk &&
        std::abs(own.volume - metrics.volume) <= kContained * metrics.volume) {
      const Pose X_WS = inner == 0 ? window_.X_AW.inverse() : Pose(window_.X_AW.inverse() * X_AB_);
      metrics = transformed(own, X_WS);
    }
    metrics.status = Status::kContained;
    metrics.area_vector = metrics.area_moment = Vec3::Zero();
    return metrics;
  }

  const Shape* shapes_[2];
  Pose X_AB_;
  const InterferenceOptions& options_;
  SurfaceSweepScratch& s_;
  Interference& out_;
  SolidView views_[2];
  OverlapWindow window_;
  SweepSpans spans_, other_;
  double volume_ = 0.0, error_ = 0.0;
};

}  // namespace

bool surface_sweep(const Shape& a, const Shape& b, const Pose& X_AB,
                   const InterferenceOptions& options, SurfaceSweepScratch& scratch,
                   Interference& out) {
  return SweepRun(a, b, X_AB, options, scratch, out).run();
}

}  // namespace volcontact
