// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/octree.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/ordered_sum.h"
#include "volcontact/base/thread_team.h"
#include "volcontact/pair/octree/cell_tree.h"
#include "volcontact/pair/octree/octree_depth.h"

namespace volcontact {
namespace {

constexpr double kPlanePatch = 1.0 - 1e-9;  // flatness of a patch on a plane
constexpr int kSumGrain = 64;               // leaves in a partial sum

OctreeScratch::Totals totals_of(const Cell& cell) {
  const Vec3& c = cell.center;
  OctreeScratch::Totals t;
  t.volume = cell.sums.volume;
  t.low = cell.low;
  t.high = cell.high;
  t.first = cell.sums.first + t.volume * c;
  const Mat3 cross = outer(c, cell.sums.first);
  t.second = cell.sums.second + cross + cross.transpose() + outer(t.volume * c, c);
  t.surface = cell.sums.surface;
  for (CellSums::Surface& surface : t.surface) surface.moment += c.cross(surface.area_vector);
  t.doubt = cell.doubt;
  return t;
}

VolumeMetrics metrics_from(const OctreeScratch::Totals& t) {
  MomentSum moments;
  moments.volume = t.volume;
  moments.first = t.first;
  moments.second = t.second;
  // S from either body; the one whose faces are in less doubt counts more.
  const double doubt = t.doubt[0] + t.doubt[1];
  const double share = doubt > 0.0 ? t.doubt[1] / doubt : 0.5;
  moments.area_vector = share * t.surface[0].area_vector - (1.0 - share) * t.surface[1].area_vector;
  moments.area_moment = share * t.surface[0].moment - (1.0 - share) * t.surface[1].moment;
  moments.area = t.surface[0].area;
  moments.counter_area = t.surface[1].area;
  return moments.metrics();
}

// Of the own volume K where the overlap may be all of the inner solid. It is certainly all of a
// convex solid that no face of the other passes through. Else a part of it may stick out, or be
// somewhere else: K is no farther off than the lower bound.
double error_of_own(const OctreeTask& task, const OctreeScratch::Totals& t, int inner) {
  const SolidView& solid = task.solid(inner);
  const double rounding = task.rounding + solid.own.volume_error;
  if (solid.convex && t.doubt[1 - inner] == 0.0) return rounding;
  return rounding + std::max(0.0, solid.own.volume - t.low);
}

// No surface of the other solid lies in the region. Where it is the only one it may be all of the
// inner solid, whose own metrics, when known, are then exact. There is no direction.
bool contained(const OctreeTask& task, const OctreeScratch::Totals& t, int inner, bool only_region,
               VolumeMetrics& metrics) {
  const VolumeMetrics& known = task.solid(inner).own;
  if (known.volume > 0.0 && only_region) {
    const double slack = 2.0 * (t.high - t.low) + task.rounding + 1e-9 * t.volume;
    if (std::abs(known.volume - t.volume) > slack) return false;
    const VolumeMetrics own = transformed(known, task.X_SW(inner).inverse());
    metrics.volume = own.volume;
    metrics.centroid = own.centroid;
    metrics.inertia = own.inertia;
    metrics.volume_error = error_of_own(task, t, inner);
    metrics.status = metrics.volume_error <= std::max(task.tolerance * own.volume, task.rounding)
                         ? Status::kContained
                         : Status::kApproximate;
  } else if (metrics.status == Status::kOk) {
    metrics.status = Status::kContained;
  }
  metrics.area_vector = metrics.area_moment = Vec3::Zero();
  return true;
}

VolumeMetrics metrics_of(const OctreeTask& task, OctreeScratch& s, LeafRange leaves,
                         bool approximate) {
  const int count = leaves.last - leaves.first;
  const auto t = ordered_sum<OctreeScratch::Totals>(
      task.team, count, kSumGrain, s.partial_totals,
      [&](int i) { return totals_of(s.cells[s.leaves[leaves.first + i]]); });
  VolumeMetrics metrics = metrics_from(t);
  metrics.volume_error = std::max(t.high - t.volume, t.volume - t.low) + task.rounding;
  metrics.status = approximate ? Status::kApproximate : Status::kOk;
  if (!(metrics.volume > 0.0)) return metrics;
  if ((metrics.counter_area == 0.0 && contained(task, t, 0, leaves.all, metrics)) ||
      (metrics.area == 0.0 && contained(task, t, 1, leaves.all, metrics))) {
    return metrics;
  }
  // Areas are estimated apart from S, and no surface has less area than S is long.
  const double least = metrics.area_vector.norm();
  metrics.area = std::max(metrics.area, least);
  metrics.counter_area = std::max(metrics.counter_area, least);
  const Vec3 n = metrics.normal();
  if (n.isZero(0.0)) return metrics;
  // First from the surface of the flatter body, whose edges are edges of the leaves' surfaces.
  const double side = t.doubt[0] <= t.doubt[1] ? -1.0 : 1.0;
  const OctreeScratch::ColumnSum columns =
      sum_columns(task, s, leaves, n, side, t.volume, metrics.volume_error);
  metrics.depth_moment = columns.moment;
  metrics.depth = columns.depth;
  // The ends of an overlap are known better than the columns between them, where the leaves show
  // them. But one that is neither convex nor on a plane may reach around what it lies on.
  if ((task.a.convex && task.b.convex) || metrics.flatness() >= kPlanePatch) {
    const double extent = farthest(task, s, leaves, metrics.centroid, n) +
                          farthest(task, s, leaves, metrics.centroid, -n);
    if (std::isfinite(extent)) metrics.depth = std::max(metrics.depth, extent);
  }
  return metrics;
}

void measure(const OctreeTask& task, OctreeScratch& s, const CellTree& tree, Interference& out) {
  if (tree.invalid()) {
    out.total.status = Status::kInvalid;
    return;
  }
  if (task.a.convex && task.b.convex) {  // the overlap is convex too
    s.site_ends.assign(1, static_cast<int>(s.leaves.size()));
  } else {
    sort_by_site(task.team, {s.cells.data(), static_cast<std::size_t>(s.cell_count)},
                 1e-12 * task.scale, task.rounding, s.leaves, s.site_ends, s.sites);
  }
  LeafRange leaves;
  leaves.all = s.site_ends.size() == 1;
  for (const int end : s.site_ends) {
    leaves.first = leaves.last;
    leaves.last = end;
    const VolumeMetrics metrics = metrics_of(task, s, leaves, tree.approximate());
    if (metrics.volume > 0.0) out.sites.push_back(transformed(metrics, task.window.X_AW));
  }
  if (out.sites.empty()) {
    out.total.volume_error = task.rounding + tree.high();
    out.total.status = tree.approximate() ? Status::kApproximate : Status::kOk;
    return;
  }
  out.total = out.sites[0];
  for (std::size_t i = 1; i < out.sites.size(); ++i) out.total = out.total + out.sites[i];
}

void run(OctreeTask& task, OctreeScratch& s, Interference& out) {
  const std::size_t threads = task.thread_limit;
  if (s.cutters.size() < threads) s.cutters.resize(threads);
  if (s.columns.size() < threads) s.columns.resize(threads);
  CellTree tree(task, s);
  if (tree.grow()) return measure(task, s, tree, out);
  task.team.run(task.thread_limit, [&] {
    tree.grow();
    measure(task, s, tree, out);
  });
}

bool unbounded(const SolidView& view) { return !view.bounds.bounded(); }

}  // namespace

OctreeScratch::Totals& OctreeScratch::Totals::operator+=(const Totals& other) {
  volume += other.volume;
  low += other.low;
  high += other.high;
  first += other.first;
  second += other.second;
  for (int i = 0; i < 2; ++i) {
    surface[i].area_vector += other.surface[i].area_vector;
    surface[i].moment += other.surface[i].moment;
    surface[i].area += other.surface[i].area;
    doubt[i] += other.doubt[i];
  }
  return *this;
}

void octree_interference(const SolidView& a, const SolidView& b, const Pose& X_AB,
                         const InterferenceOptions& options, OctreeScratch& scratch,
                         Interference& out) {
  out.total = VolumeMetrics{};
  out.sites.clear();
  out.engine = Engine::kOctree;
  if (!X_AB.is_finite()) {
    out.total.status = Status::kInvalid;
    return;
  }
  if (unbounded(a) && unbounded(b)) {
    out.total.status = Status::kUnbounded;
    return;
  }
  const auto is_nothing = [](const SolidView& view) {
    return view.own.volume == 0.0 && view.own.volume_error == 0.0;
  };
  if (is_nothing(a) || is_nothing(b)) return;
  const OverlapWindow window = find_window(a, b, X_AB, scratch.hull, scratch.part);
  if (window.apart) return;
  ThreadTeam team;
  OctreeTask task{.a = a,
                  .b = b,
                  .window = window,
                  .tolerance = options.tolerance,
                  .most_cells = options.most_cells,
                  .asked_threads = options.threads,
                  .thread_limit = thread_limit(options.threads),
                  .team = team};
  run(task, scratch, out);
}

void octree_interference(const Shape& a, const Shape& b, const Pose& X_AB,
                         const InterferenceOptions& options, OctreeScratch& scratch,
                         Interference& out) {
  octree_interference(view_of(a), view_of(b), X_AB, options, scratch, out);
}

}  // namespace volcontact
