// SPDX-License-Identifier: Apache-2.0
#include "core/reference/line_oracle.h"

#include <algorithm>

namespace volcontact::test {
namespace {

// Fibonacci numbers and those before them: lattices that are even in two dimensions.
constexpr int kLines[LineOracle::kLevels][2] = {{610, 377},        {4181, 2584},
                                                {28657, 17711},    {196418, 121393},
                                                {1346269, 832040}, {9227465, 5702887}};
constexpr std::size_t kMostCells = 600;
constexpr int kDeepest = 40;
constexpr int kFewHits = 50;  // of so few lines the spread says nothing

double part_after_point(double x) { return x - std::floor(x); }

}  // namespace

LineOracle::LineOracle(const ImplicitSolid& a, const ImplicitSolid& b_A, std::uint64_t seed)
    : a_(a), b_(b_A), random_(seed) {
  frame_ = random_.rotation();
  find_cells();
}

// A value of the implicit function at the middle of a cell that is more than the distance to its
// corners leaves nothing inside. Of two convex functions every mean is negative where both are: its
// slope is small where the two surfaces face each other, so that nearly touching ones are parted.
bool LineOracle::is_empty(const Vec3& middle_F, double reach) const {
  const Vec3 p = frame_ * middle_F;
  const double in_a = a_.value(p);
  if (in_a >= reach) return true;
  const double in_b = b_.value(p);
  if (in_b >= reach) return true;
  if (!a_.is_convex() || !b_.is_convex() || std::max(in_a, in_b) <= -reach) return false;
  const Vec3 slope_a = a_.members()[0].slope(p), slope_b = b_.members()[0].slope(p);
  const Vec3 difference = slope_a - slope_b;
  const double length = difference.squaredNorm();
  if (length == 0.0) return false;
  const double share = std::clamp(-slope_b.dot(difference) / length, 0.0, 1.0);
  const Vec3 slope = share * slope_a + (1.0 - share) * slope_b;
  return share * in_a + (1.0 - share) * in_b - slope.norm() * reach > 0.0;
}

void LineOracle::find_cells() {
  // The box of both balls, in the frame of the lines.
  const Vec3 at_a = frame_.transpose() * a_.middle, at_b = frame_.transpose() * b_.middle;
  const Vec3 reach_a = Vec3::Constant(a_.radius), reach_b = Vec3::Constant(b_.radius);
  const Vec3 low = (at_a - reach_a).cwiseMax(at_b - reach_b);
  const Vec3 high = (at_a + reach_a).cwiseMin(at_b + reach_b);
  if (!((high - low).minCoeff() > 0.0)) return;
  half_cell_ = 0.5 * (high - low);
  cells_.push_back({0.5 * (low + high)});
  double inside = 0.0;
  std::vector<Cell> next;
  for (int depth = 0; depth < kDeepest && !cells_.empty() && cells_.size() < kMostCells; ++depth) {
    const Vec3 half = 0.5 * half_cell_;
    const double reach = half.norm();
    next.clear();
    for (const Cell& cell : cells_) {
      for (int i = 0; i < 8; ++i) {
        const Vec3 middle = cell.middle + corner_signs(i).cwiseProduct(half);
        if (!is_empty(middle, reach)) next.push_back({middle});
      }
    }
    cells_.swap(next);
    half_cell_ = half;
  }
  const double cell_volume = 8.0 * half_cell_.prod(), reach = half_cell_.norm();
  low_ = Vec3::Constant(kInfinity);
  high_ = Vec3::Constant(-kInfinity);
  for (const Cell& cell : cells_) {
    const Vec3 p = frame_ * cell.middle;
    if (std::max(a_.value(p), b_.value(p)) <= -reach) inside += cell_volume;
    low_ = low_.cwiseMin(cell.middle - half_cell_);
    high_ = high_.cwiseMax(cell.middle + half_cell_);
  }
  least_volume_ = inside;
  most_volume_ = cell_volume * static_cast<double>(cells_.size());
}

LineOracle::Sum LineOracle::along(int axis, int level, Random& random) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3, lines = kLines[level][0];
  const double step = static_cast<double>(kLines[level][1]) / lines;
  const double x0 = random.uniform(), y0 = random.uniform();
  const Vec3 d = frame_.col(axis), half = 0.5 * (high_ - low_);
  SolidLines lines_a(a_, d), lines_b(b_, d);
  Sum sum;
  for (int i = 0; i < lines; ++i) {
    Vec3 o_F = 0.5 * (low_ + high_);
    o_F[u] = low_[u] + 2.0 * half[u] * part_after_point(x0 + (i + 0.5) / lines);
    o_F[v] = low_[v] + 2.0 * half[v] * part_after_point(y0 + i * step);
    const Vec3 o = frame_ * o_F;
    lines_a.parts(o, half[axis], in_a_);
    if (in_a_.count == 0) continue;
    lines_b.parts(o, half[axis], in_b_);
    add_common(axis, o_F, half[axis], sum);
  }
  const double weight = 4.0 * half[u] * half[v] / lines;
  sum.volume *= weight;
  sum.first *= weight;
  sum.flux *= weight;
  return sum;
}

// What both have of the line through o_F along the axis.
void LineOracle::add_common(int axis, const Vec3& o_F, double reach, Sum& sum) const {
  const auto *a = in_a_.begin(), *b = in_b_.begin();
  while (a != in_a_.end() && b != in_b_.end()) {
    const double enter = std::max(a->enter, b->enter), leave = std::min(a->leave, b->leave);
    if (enter < leave) {
      // A's surface where B is; ends of the box are none of the surface.
      if (a->enter > b->enter && a->enter > -reach) sum.flux -= 1.0;
      if (a->leave <= b->leave && a->leave < reach) sum.flux += 1.0;
      const double length = leave - enter;
      sum.volume += length;
      ++sum.hits;
      Vec3 p = o_F;
      p[axis] = o_F[axis] + 0.5 * (enter + leave);
      sum.first += length * p;
      p[axis] = o_F[axis] + enter;
      sum.low = sum.low.cwiseMin(p);
      sum.high = sum.high.cwiseMax(p);
      p[axis] = o_F[axis] + leave;
      sum.low = sum.low.cwiseMin(p);
      sum.high = sum.high.cwiseMax(p);
    }
    (a->leave <= b->leave ? a : b)++;
  }
}

LineEstimate LineOracle::estimate(int level) {
  LineEstimate result;
  result.extent = 0.5 * (high_ - low_).norm();
  if (is_apart()) return result;
  Sum sums[3];
  Sum all;
  for (int axis = 0; axis < 3; ++axis) {
    sums[axis] = along(axis, level, random_);
    all.volume += sums[axis].volume / 3.0;
    all.first += sums[axis].first / 3.0;
    all.low = all.low.cwiseMin(sums[axis].low);
    all.high = all.high.cwiseMax(sums[axis].high);
  }
  result.volume = all.volume;
  double least = kInfinity, most = 0.0;
  for (const Sum& sum : sums) {
    least = std::min(least, sum.volume);
    most = std::max(most, sum.volume);
  }
  result.volume_error = 1.5 * (most - least);
  const int hits = std::min({sums[0].hits, sums[1].hits, sums[2].hits});
  if (hits < kFewHits) {
    const bool is_one = a_.is_convex() && b_.is_convex();  // all of it is where some of it is
    result.volume_error = std::max(result.volume_error, is_one && hits > 0 ? most : most_volume_);
  }
  if (all.volume > 0.0) {
    const Vec3 centroid_F = all.first / all.volume;
    result.centroid = frame_ * centroid_F;
    for (const Sum& sum : sums) {
      if (!(sum.volume > 0.0)) continue;
      const double off = (sum.first / sum.volume - centroid_F).norm();
      result.centroid_error = std::max(result.centroid_error, 1.5 * off);
    }
  }
  result.share = static_cast<double>(hits) / kLines[level][0];
  result.area_vector = frame_ * Vec3(sums[0].flux, sums[1].flux, sums[2].flux);
  // What two convex solids have in common hangs together: the lines have met nearly all of it where
  // many of them did. Of a needle few do, and any part of it may be between them.
  if (a_.is_convex() && b_.is_convex() && hits >= kFewHits) {
    const Vec3 size = high_ - low_;
    const double between = 0.1 + 1.0 / std::sqrt(static_cast<double>(hits));
    const Vec3 margin = between * (all.high - all.low) +
                        4.0 / std::sqrt(static_cast<double>(kLines[level][0])) * size;
    low_ = low_.cwiseMax(all.low - margin);
    high_ = high_.cwiseMin(all.high + margin);
  }
  return result;
}

}  // namespace volcontact::test
