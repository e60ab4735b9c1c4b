// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/sampled_columns.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr int kAcross = 32;  // columns along x and along y

Aabb bounds_in(const SurfaceView& solid, const Pose& X) {
  const Vec3 middle = X * solid.bounds.center();
  const Vec3 half = X.rotation.cwiseAbs() * solid.bounds.half_sizes();
  return {middle - half, middle + half};
}

struct Sums {
  MomentSum moments;
  double energy = 0.0, depth = 0.0;
};

// The parts of one column that lie in both solids.
void add_column(double x, double y, double area, std::vector<ColumnHit>& hits, Sums& sums) {
  std::sort(hits.begin(), hits.end(), [](const ColumnHit& a, const ColumnHit& b) {
    return a.z != b.z ? a.z < b.z : a.side != b.side ? a.side < b.side : a.sign < b.sign;
  });
  int winding[2] = {0, 0};
  const ColumnHit* enter = nullptr;
  MomentSum& m = sums.moments;
  const auto add_face = [&](const ColumnHit& hit) {
    const double sign = hit.sign;
    const double stretch =
        std::sqrt(1.0 + hit.slope[0] * hit.slope[0] + hit.slope[1] * hit.slope[1]);
    (hit.side == 0 ? m.area : m.counter_area) += area * stretch;
    if (hit.side != 0) return;
    const Vec3 n(-sign * hit.slope[0], -sign * hit.slope[1], sign);
    m.area_vector += area * n;
    m.area_moment += area * Vec3(x, y, hit.z).cross(n);
  };
  for (const ColumnHit& hit : hits) {
    const bool was_in = winding[0] > 0 && winding[1] > 0;
    winding[hit.side] -= hit.sign;
    const bool is_in = winding[0] > 0 && winding[1] > 0;
    if (!was_in && is_in) enter = &hit;
    if (!was_in || is_in || enter == nullptr) continue;
    const double length = hit.z - enter->z, middle = 0.5 * (hit.z + enter->z);
    const double volume = area * length;
    const Vec3 c(x, y, middle);
    m.volume += volume;
    m.first += volume * c;
    m.second += volume * outer(c, c);
    m.second(2, 2) += volume * length * length / 12.0;
    sums.energy += 0.5 * volume * length;
    sums.depth = std::max(sums.depth, length);
    add_face(*enter);
    add_face(hit);
    enter = nullptr;
  }
}

}  // namespace

VolumeMetrics sampled_columns(const SurfaceView& a, const Pose& X_CA, const SurfaceView& b,
                              const Pose& X_CB, CellScratch& cells, SampledScratch& scratch) {
  const Aabb in_a = bounds_in(a, X_CA), in_b = bounds_in(b, X_CB);
  const Vec3 low = in_a.min.cwiseMax(in_b.min), high = in_a.max.cwiseMin(in_b.max);
  if (!low.less_than(high)) return VolumeMetrics{};
  const double dx = (high.x() - low.x()) / kAcross, dy = (high.y() - low.y()) / kAcross;
  Sums sums;
  double halves[2] = {0.0, 0.0};  // of the columns, as on a chessboard
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const double x = low.x() + (i + 0.5) * dx, y = low.y() + (j + 0.5) * dy;
      scratch.hits.clear();
      add_hits(*a.tree, X_CA, x, y, 0, cells, scratch.hits);
      if (scratch.hits.empty()) continue;
      add_hits(*b.tree, X_CB, x, y, 1, cells, scratch.hits);
      const double before = sums.moments.volume;
      add_column(x, y, dx * dy, scratch.hits, sums);
      halves[(i + j) % 2] += sums.moments.volume - before;
    }
  }
  VolumeMetrics m = sums.moments.metrics();
  m.status = Status::kApproximate;
  m.volume_error = dx * dy * (high.z() - low.z());  // of one column
  if (!m.touching()) return m;
  m.depth_moment = sums.energy;
  m.depth = sums.depth;
  m.volume_error = 2.0 * std::abs(halves[0] - halves[1]) + 0.01 * m.volume;
  return m;
}

}  // namespace volcontact
