// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/cell_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "volcontact/base/interrupt.h"
#include "volcontact/pair/octree/cell_math.h"

namespace volcontact {
namespace {

constexpr int kEvaluateGrain = 1;  // cells a thread takes at a time; one costs microseconds
// Of the doubt from which cells are divided: a new cell with more is divided in the next round.
constexpr double kRoughShare = 0.5;
constexpr double kRestShare = 1.4;  // of the tolerance, left to the cells that are not divided
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The root box is a little larger than the hull, and not in the middle of it, so that neither its
// sides nor the halvings coincide with faces of the solids.
constexpr double kMarginLow = 0.0137, kMarginHigh = 0.0091;

bool is_sampled(const SolidView& view, const PieceList& list) {
  return list.size() == 0 && !view.curvature_bound;
}

}  // namespace

void CellTree::plant() {
  s_.cell_count = 0;
  s_.faces.clear();
  s_.pieces_a.clear();
  s_.pieces_b.clear();
  if (task_.a.pieces) task_.a.pieces(task_.a.solid, s_.pieces_a);
  if (task_.b.pieces) task_.b.pieces(task_.b.solid, s_.pieces_b);
  Vec3 high = Vec3::Zero();
  for (const Vec3& p : s_.hull.points()) high = high.cwiseMax(p.cwiseAbs());
  task_.scale =
      task_.window.X_AW.translation.norm() + task_.window.X_BW.translation.norm() + high.norm();
  task_.rounding = 8.0 * kEpsilon * task_.scale *
                   (high.x() * high.y() + high.y() * high.z() + high.z() * high.x()) * 4.0;
  for (int i = 0; i < std::max(1, s_.pieces_a.size()); ++i) {
    for (int j = 0; j < std::max(1, s_.pieces_b.size()); ++j) add_region(i, j);
  }
}

void CellTree::add_faces(const SolidView& view, int owner, const PieceList& list, int piece,
                         const Pose& X_SW) {
  if (list.size() == 0) {
    CellFace& face = s_.faces.emplace_back();
    face.owner = owner;
    face.field = &view;
    face.X_SW = X_SW;
    const bool cut = face.sampled();
    // A field may go on outside of its bounds; the solid does not.
    for (int axis = 0; cut && axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const double edge = side > 0.0 ? view.bounds.max[axis] : -view.bounds.min[axis];
        if (!std::isfinite(edge)) continue;
        CellFace& plane = s_.faces.emplace_back();
        plane.owner = owner;
        plane.quadric = transformed(Quadric::plane(side * Vec3::Unit(axis), edge), X_SW);
      }
    }
    return;
  }
  for (const Quadric* q = list.begin(piece); q != list.end(piece); ++q) {
    CellFace& face = s_.faces.emplace_back();
    face.owner = owner;
    face.quadric = transformed(*q, X_SW);
  }
}

// A piece of A with a piece of B.
void CellTree::add_region(int piece_a, int piece_b) {
  const int first_face = static_cast<int>(s_.faces.size());
  add_faces(task_.a, 0, s_.pieces_a, piece_a, task_.window.X_AW);
  add_faces(task_.b, 1, s_.pieces_b, piece_b, task_.window.X_BW);
  if (cut_by_planes(first_face)) add_root(first_face, s_.part);
}

// Leaves in `part` what the region's plane faces leave of the hull. False when that is nothing.
bool CellTree::cut_by_planes(int first_face) {
  s_.part = s_.hull;
  for (std::size_t i = first_face; i < s_.faces.size(); ++i) {
    const Quadric& face = s_.faces[i].quadric;
    if (s_.faces[i].field || face.bend != Bend::kFlat) continue;
    const auto height = [&face](const Vec3& p) { return face.linear.dot(p) + face.constant; };
    if (!s_.part.cut(height, 0, 0.0)) return false;
  }
  return true;
}

void CellTree::add_root(int first_face, const CutPolytope& hull) {
  Vec3 low = Vec3::Constant(kInfinity), high = -low;
  for (const Vec3& p : hull.points()) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 extent = high - low;
  low -= kMarginLow * extent;
  high += kMarginHigh * extent;
  Cell& cell = new_cell();
  cell.center = 0.5 * (low + high);
  cell.half = 0.5 * (high - low);
  cell.first_face = first_face;
  cell.face_count = static_cast<int>(s_.faces.size()) - first_face;
  cell.listed = -1;
}

Cell& CellTree::new_cell() {
  if (s_.cell_count == static_cast<int>(s_.cells.size())) s_.cells.resize(2 * s_.cells.size() + 64);
  return s_.cells[s_.cell_count++];
}

// Asks a field, all cells at once, for the signed distances at the centres, and at the corners of
// those it may pass through.
void CellTree::sample(int owner, int first) {
  const int last = s_.cell_count;
  const SolidView& view = task_.solid(owner);
  const Pose& X_SW = task_.X_SW(owner);
  const auto ask = [&] {
    s_.sample_values.resize(s_.sample_points.size());
    view.signed_distances(view.solid, s_.sample_points.data(),
                          static_cast<int>(s_.sample_points.size()), s_.sample_values.data());
    for (double& value : s_.sample_values) {
      if (!std::isnan(value)) continue;
      value = 0.0;
      invalid_ = true;
    }
  };
  s_.sample_points.clear();
  for (int i = first; i < last; ++i) s_.sample_points.push_back(X_SW * s_.cells[i].center);
  ask();
  s_.sample_points.clear();
  s_.sampled.clear();
  for (int i = first; i < last; ++i) {
    Cell& cell = s_.cells[i];
    const double distance = cell.samples[owner][0] = s_.sample_values[i - first];
    if (!(std::abs(distance) < cell.half.norm())) continue;
    s_.sampled.push_back(i);
    for (int k = 0; k < 8; ++k) {
      const Vec3 corner = cell.center + corner_signs(k).cwiseProduct(cell.half);
      s_.sample_points.push_back(X_SW * corner);
    }
  }
  if (s_.sampled.empty()) return;
  ask();
  const double* value = s_.sample_values.data();
  for (const int i : s_.sampled) {
    std::array<double, 9>& f = s_.cells[i].samples[owner];
    const double radius = s_.cells[i].half.norm();
    // A function that is steeper than it may be must still not upset the numbers.
    for (int k = 1; k < 9; ++k) f[k] = std::clamp(*value++, f[0] - radius, f[0] + radius);
  }
}

bool CellTree::samples_fields() const {
  return is_sampled(task_.a, s_.pieces_a) || is_sampled(task_.b, s_.pieces_b);
}

void CellTree::sample_fields(int first) {
  if (is_sampled(task_.a, s_.pieces_a)) sample(0, first);
  if (is_sampled(task_.b, s_.pieces_b)) sample(1, first);
}

// A new cell becomes a part of its parent.
void CellTree::bear(int index, const OctreeScratch::Birth& birth) {
  const Cell& parent = s_.cells[birth.parent];
  Cell& cell = s_.cells[index];
  cell.center = parent.center;
  cell.half = parent.half;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(parent.split >> axis & 1)) continue;
    cell.half[axis] *= 0.5;
    cell.center[axis] += birth.child >> axis & 1 ? cell.half[axis] : -cell.half[axis];
  }
  cell.first_face = parent.first_face;
  cell.face_count = parent.face_count;
  cell.listed = parent.listed;
  cell.list = parent.list;
}

// All cells from `first` on, which are those of `births` but for roots.
void CellTree::evaluate(int first, double rough_above) {
  const int count = s_.cell_count - first;
  const auto born = static_cast<int>(s_.births.size());
  s_.fresh.resize(count);
  const bool sampled = count > 0 && samples_fields();
  if (sampled) {  // of all cells at once
    for (int i = 0; i < born; ++i) bear(first + i, s_.births[i]);
    sample_fields(first);
  }
  task_.team.for_each(count, kEvaluateGrain, [&](int i) {
    InterruptScope::poll();
    if (!sampled && i < born) bear(first + i, s_.births[i]);
    Cell& cell = s_.cells[first + i];
    s_.cutters[task_.thread()].evaluate(s_.faces, cell, rough_above);
    s_.fresh[i] = {cell.empty ? -1 : first + i, cell.split, cell.sums.volume, cell.low, cell.high};
  });
}

// New leaves: those without doubt are settled, the others pending.
void CellTree::take_up() {
  s_.is_leaf.resize(std::max(s_.is_leaf.size(), s_.cells.size()));
  int index = s_.cell_count - static_cast<int>(s_.fresh.size());
  for (const OctreeScratch::Leaf& leaf : s_.fresh) {
    s_.is_leaf[index++] = leaf.cell >= 0;
    if (leaf.cell < 0) continue;
    if (leaf.high > leaf.low) {
      s_.next_pending.push_back(leaf);
    } else {
      settled_ += leaf.volume;
    }
  }
  s_.fresh.clear();
  s_.pending = s_.next_pending;  // no swap: that would make either one grow again later
  s_.next_pending.clear();
  low_ = volume_ = high_ = settled_;
  for (const OctreeScratch::Leaf& leaf : s_.pending) {
    low_ += leaf.low;
    volume_ += leaf.volume;
    high_ += leaf.high;
  }
}

// Leaves with at least this doubt are divided; the doubts of the others add up to a share of the
// tolerance at most. In bins of a quarter of a power of two, so that one pass is enough.
double CellTree::threshold() const {
  constexpr int kBins = 256, kShift = 50;  // leaves exponent and two bits of the fraction
  const auto key = [](double x) { return std::bit_cast<std::int64_t>(x) >> kShift; };
  double largest = 0.0;
  for (const auto& leaf : s_.pending) largest = std::max(largest, leaf.high - leaf.low);
  const std::int64_t top = key(largest);
  std::array<double, kBins> bins{};
  for (const auto& leaf : s_.pending) {
    const double doubt = leaf.high - leaf.low;
    const std::int64_t bin = top - key(doubt);
    if (bin < kBins) bins[bin] += doubt;
  }
  double rest = 0.0;
  int bin = kBins - 1;
  while (bin > 0 && rest + bins[bin] <= kRestShare * task_.tolerance * volume_) rest += bins[bin--];
  return std::bit_cast<double>((top - bin) << kShift);
}

bool CellTree::precise() const {
  return std::max(high_ - volume_, volume_ - low_) <=
         std::max(task_.tolerance * volume_, task_.rounding);
}

// Works out the leaves that were left rough; their estimates take the place of the middle of their
// bounds.
void CellTree::smooth() {
  const int count = static_cast<int>(s_.pending.size());
  task_.team.for_each(count, kEvaluateGrain, [&](int i) {
    OctreeScratch::Leaf& leaf = s_.pending[i];
    Cell& cell = s_.cells[leaf.cell];
    if (!cell.rough) return;
    s_.cutters[task_.thread()].evaluate(s_.faces, cell);
    leaf.volume = cell.sums.volume;
  });
  s_.next_pending = s_.pending;
  s_.pending.clear();
  take_up();
}

// Divides the leaves with much doubt. False when the budget of cells does not allow it.
bool CellTree::divide_worst() {
  const double least = threshold();
  const int first = s_.cell_count;
  int children = 0;
  for (const auto& leaf : s_.pending) {
    if (leaf.high - leaf.low >= least) children += 1 << std::popcount(leaf.split);
  }
  if (first + children > task_.most_cells) return false;
  s_.births.clear();
  for (const auto& leaf : s_.pending) {
    if (!(leaf.high - leaf.low >= least)) {
      s_.next_pending.push_back(leaf);
      continue;
    }
    s_.is_leaf[leaf.cell] = false;
    for (std::uint8_t child = 0; child < 8; ++child) {
      if (child & ~leaf.split) continue;
      new_cell();
      s_.births.push_back({leaf.cell, child});
    }
  }
  evaluate(first, kRoughShare * least);
  take_up();
  return true;
}

// Whether others would help, who are not at hand yet.
bool CellTree::wants_team() const {
  return !task_.team.open() && task_.worth_sharing(2 * static_cast<int>(s_.pending.size()));
}

bool CellTree::refine() {
  do {
    while (!precise() && !approximate_) {
      if (wants_team()) return false;
      approximate_ = !divide_worst();
    }
    smooth();
  } while (!precise() && !approximate_);
  approximate_ = !precise();
  return true;
}

bool CellTree::grow() {
  if (!planted_) {
    plant();
    s_.pending.clear();
    s_.next_pending.clear();
    s_.births.clear();
    evaluate(0, 0.0);
    take_up();
    planted_ = true;
  }
  if (!refine()) return false;
  s_.leaves.clear();
  for (int i = 0; i < s_.cell_count; ++i) {
    if (s_.is_leaf[i]) s_.leaves.push_back(i);
  }
  return true;
}

}  // namespace volcontact
