// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/cell_cut.h"

#include <algorithm>

#include "volcontact/pair/octree/cell_math.h"

namespace volcontact {

using namespace cell_math;

namespace {

constexpr double kSplitShare = 0.4;    // axes with this share of the largest score are halved
constexpr double kOthersShare = 0.25;  // weight of the other faces' bend in a face's doubt
constexpr double kLeastLeft = 1e-2;    // of a polytope, for its faces to stand for the surface
constexpr double kMostShare = 2.0;     // of the volume sampled, to which it may be corrected
constexpr double kPlaceSlack = 1e-9;   // of the box
constexpr int kMostSteps = 12;         // to a place behind all faces

}  // namespace

void CellCut::cut(const Vec3& half) {
  half_ = half;
  polytope_.start(box_graph());
  for (int i = 0; i < 8; ++i) polytope_.points()[i] = corner_signs(i).cwiseProduct(half);
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    const Tangent& t = tangents_[i];
    const auto height = [&t](const Vec3& x) { return t.plane(x); };
    if (!polytope_.cut(height, kFirstFace + static_cast<int>(i), 0.0)) return;
  }
}

double CellCut::polytope_volume() const {
  const auto points = polytope_.points();
  double six = 0.0;
  for (const FaceLoop& loop : loops_) {
    const int* index = polytope_.loop_vertices().data() + loop.first;
    const Vec3& p = points[index[0]];
    for (int i = 2; i < loop.count; ++i) {
      six += p.dot(points[index[i - 1]].cross(points[index[i]]));
    }
  }
  return std::max(0.0, six / 6.0);
}

// Moments from the faces by the divergence theorem: tetrahedra from the cell's centre.
void CellCut::add_polytope(CellSums& sums) const {
  const auto points = polytope_.points();
  for (const FaceLoop& loop : loops_) {
    const int* index = polytope_.loop_vertices().data() + loop.first;
    const Vec3& p = points[index[0]];
    for (int i = 2; i < loop.count; ++i) {
      const Vec3 &q = points[index[i - 1]], &r = points[index[i]];
      const double six = p.dot(q.cross(r));
      const Vec3 sum = p + q + r;
      sums.volume += six / 6.0;
      sums.first += six / 24.0 * sum;
      sums.second += six / 120.0 * (outer(sum, sum) + outer(p, p) + outer(q, q) + outer(r, r));
    }
  }
}

void CellCut::bound(Cell& cell) {
  const double cell_volume = 8.0 * cell.half.prod();
  cell.low = cell.high = polytope_volume();
  gaps_.assign(tangents_.size(), Gap{});
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    if (tangents_[i].exact()) continue;
    const Gap& gap = gaps_[i] = gap_of(static_cast<int>(i), cell.half);
    cell.low -= gap.high;
    cell.high -= gap.low;
    cell.doubt[tangents_[i].owner] += gap.high - gap.low;
  }
  // Not a number, from a degenerate plane, bounds nothing.
  cell.low = cell.low >= 0.0 ? std::min(cell.low, cell_volume) : 0.0;
  cell.high = cell.high <= cell_volume ? std::max(cell.high, cell.low) : cell_volume;
}

void CellCut::estimate(Cell& cell) {
  CellSums& sums = cell.sums;
  add_polytope(sums);
  const double polytope = sums.volume;
  add_surfaces(sums);
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    const Moments& between = between_[i];
    if (between.volume == 0.0) continue;
    const double volume = std::clamp(between.volume, gaps_[i].low, gaps_[i].high);
    const double share = volume / between.volume;
    sums.volume -= volume;
    if (share >= 0.0 && share <= kMostShare) {
      sums.first -= share * between.first;
      sums.second -= share * between.second;
      continue;
    }
    // Samples that all but cancel say nothing about where the volume is: it is at the face.
    const Vec3 at = tangents_[i].touch.cwiseMax(-half_).cwiseMin(half_);
    sums.first -= volume * at;
    sums.second -= outer(volume * at, at);
  }
  const double inside = std::clamp(sums.volume, cell.low, cell.high);
  if (inside != sums.volume) {
    const double scale = sums.volume > 0.0 ? inside / sums.volume : 0.0;
    sums.volume = inside;
    sums.first *= scale;
    sums.second *= scale;
  }
  // Where the faces leave hardly anything of the polytope, its own faces are not theirs.
  if (sums.volume < kLeastLeft * polytope) sums.surface = {};
  limit_surfaces(cell);
  place(cell);
}

// A face shows no more of itself along an axis than the side of the cell. The foot of a sample on a
// face that bends back within the cell may.
void CellCut::limit_surfaces(Cell& cell) const {
  const Vec3& h = cell.half;
  const Vec3 side = 4.0 * Vec3(h.y() * h.z(), h.z() * h.x(), h.x() * h.y());
  int faces[2] = {0, 0};
  for (const Tangent& t : tangents_) faces[t.owner] += t.seam ? 0 : 1;
  for (int owner = 0; owner < 2; ++owner) {
    CellSums::Surface& surface = cell.sums.surface[owner];
    const double share =
        (faces[owner] * side).cwiseQuotient(surface.area_vector.cwiseAbs()).minCoeff();
    if (!(share < 1.0)) continue;
    surface.area_vector *= share;
    surface.moment *= share;
    surface.area *= share;
  }
}

// Next to `from` in the box and behind every face that is flat or convex: there the centroid of
// what they hold lies. Step by step, each to the face that `at` is farthest in front of.
Vec3 CellCut::behind_faces(const Cell& cell, const Vec3& from) const {
  const double slack = kPlaceSlack * (cell.content_high - cell.content_low).norm();
  Vec3 at = from.cwiseMax(cell.content_low).cwiseMin(cell.content_high);
  for (int step = 0; step < kMostSteps; ++step) {
    double farthest = slack;
    Vec3 way = Vec3::Zero();
    for (const Tangent& t : tangents_) {
      if (t.slack > 0.0 || (t.bend != Bend::kFlat && t.bend != Bend::kConvex)) continue;
      const Vec3 slope = t.slope + t.hessian * (at - t.touch);
      const double value = t.plane(at) + t.bend_at(at), size = slope.norm();
      if (!(value > farthest * size)) continue;
      farthest = value / size;
      way = slope / size;
    }
    if (farthest == slack) return at;
    at = (at - farthest * way).cwiseMax(cell.content_low).cwiseMin(cell.content_high);
  }
  // Between faces that all but meet the steps are short. The middle of the polytope is behind the
  // flat ones.
  if (polytope_.size() == 0) return at;
  Vec3 behind = Vec3::Zero();
  for (const Vec3& p : polytope_.points()) behind += p;
  behind /= polytope_.size();
  double share = 1.0;  // of the way from there
  for (const Tangent& t : tangents_) {
    const double first = t.plane(behind), last = t.plane(at);
    if (!t.exact() || last <= 0.0 || !(first < last)) continue;
    share = std::min(share, std::max(0.0, first / (first - last)));
  }
  return behind + share * (at - behind);
}

// Where next to nothing is left of the volumes that were added and taken away, their moments need
// not belong to any body in the cell: then what is left is put next to them, where it can be.
void CellCut::place(Cell& cell) const {
  CellSums& sums = cell.sums;
  if (!(sums.volume > 0.0)) {
    sums.first.setZero();
    sums.second.setZero();
    return;
  }
  const Vec3 middle = sums.first / sums.volume, size = cell.content_high - cell.content_low;
  const Vec3 at = behind_faces(cell, middle);
  const Vec3 spread = sums.second.diagonal() / sums.volume - middle.cwiseAbs2();
  const double slack = kPlaceSlack * size.squaredNorm();
  const bool spreads =
      spread.minCoeff() >= -slack && (spread - 0.25 * size.cwiseAbs2()).maxCoeff() <= slack;
  if ((at - middle).norm() <= kPlaceSlack * size.norm() && spreads) return;
  if (spreads) {
    sums.second += sums.volume * (outer(at, at) - outer(middle, middle));
  } else {
    sums.second = outer(sums.volume * at, at);
  }
  sums.first = sums.volume * at;
}

// From the corners of the polytope, and as far outside as the faces bend.
void CellCut::enclose(Cell& cell) const {
  double slack = 0.0;
  for (const Tangent& t : tangents_) {
    if (t.beyond() > 0.0) slack = std::max(slack, t.beyond() / t.slope.norm());
  }
  cell.content_low = cell.half;
  cell.content_high = -cell.half;
  for (const Vec3& p : polytope_.points()) {
    cell.content_low = cell.content_low.cwiseMin(p);
    cell.content_high = cell.content_high.cwiseMax(p);
  }
  if (!(slack < kInfinity) || polytope_.size() == 0) slack = 2.0 * cell.half.maxCoeff();
  const Vec3 wider = Vec3::Constant(slack);
  cell.content_low = (cell.content_low - wider).cwiseMax(-cell.half);
  cell.content_high = (cell.content_high + wider).cwiseMin(cell.half);
}

// Halving an axis helps against a bend along it; a straight cylinder is never cut across.
void CellCut::choose_split(Cell& cell) const {
  const auto share_of = [&](std::size_t i) -> Vec3 {
    const Tangent& t = tangents_[i];
    Vec3 share = t.hessian.diagonal().cwiseAbs().cwiseProduct(gaps_[i].reach.cwiseAbs2());
    if (t.slack > 0.0 || !(share.sum() > 0.0)) share = cell.half.cwiseAbs2();
    return share / share.sum();
  };
  Vec3 others = Vec3::Zero(), score = Vec3::Zero();
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    if (!tangents_[i].exact()) others += kOthersShare * share_of(i);
  }
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    if (!tangents_[i].exact()) score += (gaps_[i].high - gaps_[i].low) * (share_of(i) + others);
  }
  cell.split = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (score[axis] >= kSplitShare * score.maxCoeff()) cell.split |= 1u << axis;
  }
}

void CellCut::evaluate(const std::vector<CellFace>& faces, Cell& cell, double rough_above) {
  cell.sums = CellSums{};
  cell.low = cell.high = 0.0;
  cell.doubt = {0.0, 0.0};
  cell.rough = false;
  cell.empty = !collect(faces, cell);
  if (cell.empty) return;
  cut(cell.half);
  cell.content_low = -cell.half;
  cell.content_high = cell.half;
  if (tangents_.empty()) {
    cell.sums.volume = cell.low = cell.high = 8.0 * cell.half.prod();
    cell.sums.second = (cell.sums.volume / 3.0 * cell.half.cwiseAbs2()).asDiagonal();
    return;
  }
  const bool bounded_by_planes = std::all_of(tangents_.begin(), tangents_.end(),
                                             [](const Tangent& t) { return t.beyond() == 0.0; });
  cell.empty = polytope_.size() == 0 && bounded_by_planes;
  if (cell.empty) return;
  loops_ = polytope_.faces();
  bound(cell);
  choose_split(cell);
  enclose(cell);
  cell.rough = cell.high - cell.low > rough_above;
  if (cell.rough) {
    cell.sums.volume = 0.5 * (cell.low + cell.high);
  } else {
    estimate(cell);
  }
}

}  // namespace volcontact
