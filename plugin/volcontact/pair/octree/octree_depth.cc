// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/octree_depth.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/octree/piece_ray.h"

namespace volcontact {
namespace {

constexpr int kDepthLeavesPerTask = 2;  // few: threads that wait for the last one do nothing
constexpr double kColumnShare = 2.0;    // of the tolerance, for the volume that columns add up to
constexpr double kColumnTolerance = 1e-4;  // ... which is not asked to be finer than this
constexpr double kPatches = 4.0;  // over the tolerance: to so many leaves are divided for columns
constexpr double kNudge = 1e-6;   // from the surface, in sizes of the scene
constexpr int kMostDepthSteps = 100;  // of a signed distance, along one column

// Columns along n that end on the side `side` n in the surface of a leaf.
class ColumnPass {
 public:
  ColumnPass(const OctreeTask& task, OctreeScratch& scratch, const Vec3& n, double side)
      : task_(task), s_(scratch), n_(n), side_(side) {}

  OctreeScratch::ColumnSum sum(LeafRange leaves, int levels, bool fine);

 private:
  // Known by its signed distances alone, which are asked for best in great numbers.
  bool is_field(int owner) const {
    return !task_.solid(owner).ray && (owner == 0 ? s_.pieces_a : s_.pieces_b).size() == 0;
  }
  void start(int leaf, int levels, bool fine, OctreeScratch::Columns& columns) const;
  void follow(int owner, OctreeScratch::Columns& columns) const;
  void follow_field(int owner, OctreeScratch::Columns& columns) const;
  OctreeScratch::ColumnSum total(const OctreeScratch::Columns& columns) const;

  const OctreeTask& task_;
  OctreeScratch& s_;
  const Vec3& n_;
  const double side_;
};

void ColumnPass::start(int leaf, int levels, bool fine, OctreeScratch::Columns& columns) const {
  Cell cell = s_.cells[leaf];
  s_.cutters[task_.thread()].for_each_surface_point(
      s_.faces, cell, side_ * n_, levels, fine, [&](const CellCut::SurfacePoint& point) {
        const double area = side_ * n_.dot(point.element);
        if (area * point.sign > 0.0) columns.starts.push_back({cell.center + point.position, area});
      });
}

// The part of each column within one solid: all of it when the solid has rays, else what hangs
// together with the start.
void ColumnPass::follow(int owner, OctreeScratch::Columns& columns) const {
  if (is_field(owner)) return follow_field(owner, columns);
  const SolidView& view = task_.solid(owner);
  const Pose& X_SW = task_.X_SW(owner);
  const Vec3 n_S = X_SW.rotation * n_;
  const PieceList& pieces = owner == 0 ? s_.pieces_a : s_.pieces_b;
  std::vector<RayInterval>& within = columns.within[owner];
  within.clear();
  for (const auto& from : columns.starts) {
    if (view.ray) {
      within.push_back(view.ray(view.solid, X_SW * from.p_W, n_S));
      continue;
    }
    const double way = way_inside(pieces, X_SW * from.p_W, -side_ * n_S, kNudge * task_.scale);
    within.push_back(side_ > 0.0 ? RayInterval{-way, 0.0} : RayInterval{0.0, way});
  }
}

// How far p + t d stays in the box.
double way_in_box(const Aabb& box, const Vec3& p, const Vec3& d) {
  double way = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = d[axis] > 0.0 ? box.max[axis] : box.min[axis];
    if (d[axis] != 0.0) way = std::min(way, (edge - p[axis]) / d[axis]);
  }
  return std::max(0.0, way);
}

// Steps of the signed distance from just below each start to the far side, all columns together.
void ColumnPass::follow_field(int owner, OctreeScratch::Columns& columns) const {
  const SolidView& view = task_.solid(owner);
  const Pose& X_SW = task_.X_SW(owner);
  const double nudge = kNudge * task_.scale;
  std::vector<RayInterval>& within = columns.within[owner];
  within.assign(columns.starts.size(), RayInterval{0.0, nudge});
  columns.open.resize(columns.starts.size());
  for (std::size_t i = 0; i < columns.open.size(); ++i) columns.open[i] = static_cast<int>(i);
  for (int step = 0; step < kMostDepthSteps && !columns.open.empty(); ++step) {
    columns.points.clear();
    for (const int i : columns.open) {
      columns.points.push_back(X_SW * (columns.starts[i].p_W - within[i].leave * side_ * n_));
    }
    columns.distances.resize(columns.points.size());
    view.signed_distances(view.solid, columns.points.data(),
                          static_cast<int>(columns.points.size()), columns.distances.data());
    std::size_t open = 0;
    for (std::size_t k = 0; k < columns.open.size(); ++k) {
      const double way = -columns.distances[k];
      if (!(way > 0.01 * nudge)) continue;
      within[columns.open[k]].leave += way;
      columns.open[open++] = columns.open[k];
    }
    columns.open.resize(open);
  }
  const Vec3 d_S = X_SW.rotation * (-side_ * n_);
  for (std::size_t i = 0; i < within.size(); ++i) {
    double way = within[i].leave > nudge ? within[i].leave : 0.0;
    way = std::min(way, way_in_box(view.bounds, X_SW * columns.starts[i].p_W, d_S));
    within[i] = side_ > 0.0 ? RayInterval{-way, 0.0} : RayInterval{0.0, way};
  }
}

OctreeScratch::ColumnSum ColumnPass::total(const OctreeScratch::Columns& columns) const {
  OctreeScratch::ColumnSum sum;
  for (std::size_t i = 0; i < columns.starts.size(); ++i) {
    const RayInterval &in_a = columns.within[0][i], &in_b = columns.within[1][i];
    if (in_a.empty() || in_b.empty()) continue;
    const double length = std::min(in_a.leave, in_b.leave) - std::max(in_a.enter, in_b.enter);
    if (!(length > 0.0)) continue;
    // Where A ends inside of B the column keeps its length under a push, and its force.
    const double pushed = in_b.leave - in_a.enter;
    const double lever = std::isfinite(pushed) ? pushed - 0.5 * length : 0.5 * length;
    const double volume = columns.starts[i].area * length;
    sum.volume += volume;
    sum.moment += volume * lever;
    sum.depth = std::max(sum.depth, length);
  }
  return sum;
}

OctreeScratch::ColumnSum ColumnPass::sum(LeafRange leaves, int levels, bool fine) {
  const bool fields = is_field(0) || is_field(1);
  const int count = leaves.last - leaves.first, grain = fields ? count : kDepthLeavesPerTask;
  const int tasks = (count + grain - 1) / grain;
  if (s_.partial_columns.size() < static_cast<std::size_t>(tasks)) s_.partial_columns.resize(tasks);
  task_.team.for_each(tasks, 1, [&](int task) {
    OctreeScratch::Columns& columns = s_.columns[task_.thread()];
    columns.starts.clear();
    const int last = std::min(count, (task + 1) * grain);
    for (int i = task * grain; i < last; ++i) {
      start(s_.leaves[leaves.first + i], levels, fine, columns);
    }
    follow(0, columns);
    follow(1, columns);
    s_.partial_columns[task] = total(columns);
  });
  OctreeScratch::ColumnSum all;
  for (int task = 0; task < tasks; ++task) {
    all.volume += s_.partial_columns[task].volume;
    all.moment += s_.partial_columns[task].moment;
    all.depth = std::max(all.depth, s_.partial_columns[task].depth);
  }
  return all;
}

bool holds(const Aabb& box, const Vec3& p) {
  return (p - box.min).minCoeff() >= 0.0 && (box.max - p).minCoeff() >= 0.0;
}

// When a farthest point of one convex solid lies in the other, it is the overlap's.
bool farthest_support(const OctreeTask& task, const Vec3& e, double& height) {
  for (const int owner : {0, 1}) {
    const SolidView &own = task.solid(owner), &other = task.solid(1 - owner);
    if (!own.support) continue;
    const Vec3 p_S = own.support(own.solid, task.X_SW(owner).rotation * e);
    if (!p_S.allFinite()) continue;
    const Vec3 p_W = task.X_SW(owner).inverse() * p_S;
    const Vec3 p_other = task.X_SW(1 - owner) * p_W;
    double distance;
    other.signed_distances(other.solid, &p_other, 1, &distance);
    if (distance > 1e-12 * task.scale || !holds(other.bounds, p_other)) continue;
    height = e.dot(p_W);
    return true;
  }
  return false;
}

// Greatest height in a leaf, or `least` when that is more.
double farthest_in(const OctreeTask& task, OctreeScratch& s, int leaf, const Vec3& e,
                   double least) {
  Cell cell = s.cells[leaf];
  const double center = e.dot(cell.center);
  const double reach =
      (e.cwiseProduct(cell.content_low)).cwiseMax(e.cwiseProduct(cell.content_high)).sum();
  if (!(cell.sums.volume > 0.0) || center + reach <= least) return least;
  s.cutters[task.thread()].for_each_corner(s.faces, cell, e, [&](const Vec3& corner) {
    least = std::max(least, center + e.dot(corner));
  });
  return least;
}

}  // namespace

// L may have kinks where no leaf ends; the volume, known better, tells whether the columns saw
// them, as far as it is known. Columns are followed from one side, then from the other, then more
// densely.
OctreeScratch::ColumnSum sum_columns(const OctreeTask& task, OctreeScratch& scratch,
                                     LeafRange leaves, const Vec3& n, double first_side,
                                     double volume, double volume_error) {
  struct Density {
    int levels;
    bool fine;
  };
  constexpr Density kDensities[] = {{0, false}, {0, true}, {1, true}, {2, true}, {3, true}};
  OctreeScratch::ColumnSum best;
  double least_error = kInfinity;
  const double asked = kColumnShare * std::max(task.tolerance, kColumnTolerance) * volume;
  const double allowed = std::max(asked, volume_error) + task.rounding;
  const double count = leaves.last - leaves.first;
  for (const auto [levels, fine] : kDensities) {
    if (levels > 0 && std::ldexp(count, 2 * levels) * task.tolerance > kPatches) break;
    const double before = least_error;
    for (const double side : {first_side, -first_side}) {
      const auto sum = ColumnPass(task, scratch, n, side).sum(leaves, levels, fine);
      const double error = std::abs(sum.volume - volume);
      if (error < least_error) {
        least_error = error;
        best = sum;
      }
      if (error <= allowed) return best;
    }
    if (levels > 0 && least_error > 0.5 * before) break;  // more of them would not help
  }
  return best;
}

double farthest(const OctreeTask& task, OctreeScratch& s, LeafRange leaves, const Vec3& inside,
                const Vec3& e) {
  if (task.a.convex && task.b.convex) {
    return overlap_height(task.a, task.b, task.window, s.hull, inside, e, s.part);
  }
  double height = -kInfinity;
  if (leaves.all && farthest_support(task, e, height)) return height;
  // One promising leaf first: most others can then be seen to reach less far.
  int best = leaves.first;
  double promised = -kInfinity;
  for (int i = leaves.first; i < leaves.last; ++i) {
    const Cell& cell = s.cells[s.leaves[i]];
    if (!(cell.low > 0.0) || e.dot(cell.center) <= promised) continue;
    promised = e.dot(cell.center);
    best = i;
  }
  height = farthest_in(task, s, s.leaves[best], e, height);
  const int count = leaves.last - leaves.first;
  const int tasks = (count + kDepthLeavesPerTask - 1) / kDepthLeavesPerTask;
  s.partial_heights.assign(tasks, height);
  task.team.for_each(tasks, 1, [&](int k) {
    const int last = std::min(leaves.last, leaves.first + (k + 1) * kDepthLeavesPerTask);
    for (int i = leaves.first + k * kDepthLeavesPerTask; i < last; ++i) {
      s.partial_heights[k] = farthest_in(task, s, s.leaves[i], e, s.partial_heights[k]);
    }
  });
  return *std::max_element(s.partial_heights.begin(), s.partial_heights.begin() + tasks);
}

}  // namespace volcontact
