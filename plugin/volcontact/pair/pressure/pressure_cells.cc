// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/pressure/pressure_cells.h"

#include <algorithm>
#include <utility>

#include "volcontact/pair/clip/clip_solids.h"
#include "volcontact/pair/quadrature/region_sum.h"

namespace volcontact {
namespace {

using namespace clipping;

using Layer = PressureScratch::Layer;

constexpr double kParallel = 1e-13;  // change of psi along the overlap that is rounding noise

// Volume and first moment of a cell, about the local origin.
struct CellSum {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();

  void add(CutPolytope& cell) {
    const std::span<const FaceLoop> faces = cell.faces();
    const std::span<const Vec3> points = std::as_const(cell).points();
    const int* loops = cell.loop_vertices().data();
    for (const FaceLoop& face : faces) {
      const Vec3& p = points[loops[face.first]];
      for (int i = 2; i < face.count; ++i) {
        const Vec3 &q = points[loops[face.first + i - 1]], &r = points[loops[face.first + i]];
        const double six = p.dot(q.cross(r));
        volume += six / 6.0;
        first += six / 24.0 * (p + q + r);
      }
    }
  }
};

class Field {
 public:
  Field(double share_of_a, PressureScratch& scratch)
      : share_of_a_(share_of_a), s_(scratch), layers_(scratch.layers) {
    layers_.clear();
  }

  template <typename Solid>
  void add_layers(const Solid& solid, bool of_a) {
    const double share = of_a ? share_of_a_ : 1.0 - share_of_a_;
    if (!(share > 0.0)) return;  // rigid
    for (int f = 0; f < solid.size(); ++f) {
      layers_.push_back({solid.offset(f) / share, Vec3(-solid.normal(f) / share), of_a});
    }
  }

  // The overlap is in scratch.clip.polytope, about the local origin.
  PressureField integrate() {
    drop_stiff_layers();
    s_.overlap = s_.clip.polytope;
    const bool a_is_rigid = !(share_of_a_ > 0.0);  // what B's layers press comes back on A
    PressureField field;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      s_.clip.polytope = s_.overlap;
      if (!cut_cell(i)) continue;
      CellSum cell;
      cell.add(s_.clip.polytope);
      const Layer& layer = layers_[i];
      field.energy += layer.at_origin * cell.volume + layer.slope.dot(cell.first);
      if (layer.of_a == a_is_rigid) continue;
      field.force += cell.volume * layer.slope;
      field.couple += cell.first.cross(layer.slope);
    }
    if (a_is_rigid) field.force = -field.force, field.couple = -field.couple;
    return field;
  }

 private:
  // Layers that are nowhere in the overlap the softest one.
  void drop_stiff_layers() {
    const std::span<const Vec3> corners = std::as_const(s_.clip.polytope).points();
    double ceiling = kInfinity;
    for (const Layer& layer : layers_) {
      double high = 0.0;
      for (const Vec3& x : corners) high = std::max(high, layer(x));
      ceiling = std::min(ceiling, high);
    }
    std::erase_if(layers_, [&](const Layer& layer) {
      return std::all_of(corners.begin(), corners.end(),
                         [&](const Vec3& x) { return layer(x) > ceiling; });
    });
    size_ = 0.0;
    for (const Vec3& x : corners) size_ = std::max(size_, x.norm());
  }

  // What is left of the overlap where layer i is the softest; false for nothing.
  bool cut_cell(std::size_t i) {
    const Layer& own = layers_[i];
    for (std::size_t j = 0; j < layers_.size(); ++j) {
      if (j == i) continue;
      const Layer& other = layers_[j];
      const Vec3 slope = own.slope - other.slope;
      const double at_origin = own.at_origin - other.at_origin, steepness = slope.norm();
      if (steepness <= kParallel * own.slope.norm()) {
        // Of two layers that are the same everywhere the first one counts.
        const double noise = kParallel * own.slope.norm() * size_;
        if (at_origin > noise || (at_origin >= -noise && j < i)) return false;
        continue;
      }
      const auto height = [&](const Vec3& x) { return (at_origin + slope.dot(x)) / steepness; };
      if (!s_.clip.polytope.cut(height, static_cast<int>(j), 0.0)) return false;
    }
    return true;
  }

  double share_of_a_;
  PressureScratch& s_;
  std::vector<Layer>& layers_;
  double size_ = 0.0;
};

AlignedBox aligned(const Box& a, const Vec3& origin) { return {a.half_sizes(), origin}; }
AlignedPolytope aligned(const ConvexPolytope& a, const Vec3& origin) { return {a, origin}; }
PosedBox posed(const Box& b, const Mat3& rotation, const Vec3& p) {
  return {b.half_sizes(), rotation, p};
}
PosedPolytope posed(const ConvexPolytope& b, const Mat3& rotation, const Vec3& p) {
  return {b, rotation, p};
}

template <typename A, typename B>
PressureField cells_of(const A& a, const B& b, const Pose& X_AB, const Vec3& centroid,
                       double share_of_a, PressureScratch& scratch) {
  const auto solid_a = aligned(a, centroid);
  const auto solid_b = posed(b, X_AB.rotation, X_AB.translation - centroid);
  start(solid_b, scratch.clip);
  const Vec3 middle_b = X_AB * b.bounds().center() - centroid;
  const double rounding =
      4.0 * kEpsilon * (middle_b.cwiseAbs().sum() + b.bounds().half_sizes().sum());
  if (!cut(solid_a, middle_b, solid_b.size(), rounding, scratch.clip.polytope)) return {};
  Field field(share_of_a, scratch);
  field.add_layers(solid_a, true);
  field.add_layers(solid_b, false);
  return field.integrate();
}

}  // namespace

PressureField pressure_cells(const Box& a, const Box& b, const Pose& X_AB, const Vec3& centroid,
                             double share_of_a, PressureScratch& scratch) {
  return cells_of(a, b, X_AB, centroid, share_of_a, scratch);
}

PressureField pressure_cells(const Box& a, const ConvexPolytope& b, const Pose& X_AB,
                             const Vec3& centroid, double share_of_a, PressureScratch& scratch) {
  return cells_of(a, b, X_AB, centroid, share_of_a, scratch);
}

PressureField pressure_cells(const ConvexPolytope& a, const Box& b, const Pose& X_AB,
                             const Vec3& centroid, double share_of_a, PressureScratch& scratch) {
  return cells_of(a, b, X_AB, centroid, share_of_a, scratch);
}

PressureField pressure_cells(const ConvexPolytope& a, const ConvexPolytope& b, const Pose& X_AB,
                             const Vec3& centroid, double share_of_a, PressureScratch& scratch) {
  return cells_of(a, b, X_AB, centroid, share_of_a, scratch);
}

}  // namespace volcontact
