// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/column_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "volcontact/base/first_failure.h"
#include "volcontact/pair/mesh_columns/crossing/leaf_cache.h"

namespace volcontact {
namespace {

// A triangle whose projection is smaller than this fraction of its size squared stands upright and
// bounds no column.
constexpr double kLeastArea = 1e-13;

// A triangle in C, its corners counterclockwise seen from above.
struct ColumnFace {
  double x[3], y[3];
  double slope_x, slope_y, level;  // height = level + slope_x x + slope_y y
  int sign;                        // -1: seen from above its outward side is below
};

// The line a x + b y + c = 0 through corners e and e + 1, positive to the left.
struct Line {
  double a, b, c;
  double operator()(double x, double y) const { return a * x + b * y + c; }
  double highest(const ColumnFace& face) const {
    const double v0 = (*this)(face.x[0], face.y[0]), v1 = (*this)(face.x[1], face.y[1]),
                 v2 = (*this)(face.x[2], face.y[2]);
    return std::max(v0, std::max(v1, v2));
  }
};
Line line_of(const ColumnFace& face, int e) {
  const int next = e == 2 ? 0 : e + 1;
  const double a = face.y[e] - face.y[next], b = face.x[next] - face.x[e];
  return {a, b, -(a * face.x[e] + b * face.y[e])};
}

// A cut adds one corner to a convex polygon, and up to half of them to one that rounding has bent.
struct Polygon {
  double x[2 * kLanes], y[2 * kLanes];
  signed char label[2 * kLanes];  // of the edge that begins here
  int count;
};

// Where the part of a triangle below z = 0 lies.
enum class Place { kWithin, kBeyond, kAcross };

Place place_in(const double corners[3][3], const ColumnPrism& prism) {
  Vec3 p[4];
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    const double *from = corners[i], *to = corners[i == 2 ? 0 : i + 1];
    if (from[2] <= 0.0) p[count++] = Vec3(from[0], from[1], from[2]);
    if ((from[2] <= 0.0) != (to[2] <= 0.0)) {
      const double t = from[2] / (from[2] - to[2]);
      p[count++] = Vec3(from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]), 0.0);
    }
  }
  bool within = true;
  for (const SurfacePlane& side : prism.sides) {
    double low = kInfinity, high = -kInfinity;
    for (int i = 0; i < count; ++i) {
      const double value = side.normal.dot(p[i]) - side.offset;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (low > prism.margin) return Place::kBeyond;
    within = within && high < -prism.margin;
  }
  return within ? Place::kWithin : Place::kAcross;
}

const ColumnWindow kAxis{Vec3::Zero(), Vec3::Zero()};

// Whether the z axis passes through a face: 1 yes, 0 no, -1 too near to an edge to say.
int hits_axis(const ColumnFace& face, bool usable) {
  if (!usable) return -1;
  bool near = false;
  for (int e = 0; e < 3; ++e) {
    const Line line = line_of(face, e);
    const double margin =
        1e-12 * (std::abs(line.a) + std::abs(line.b)) * (std::abs(face.x[e]) + std::abs(face.y[e]));
    if (line.c < -margin) return 0;
    near |= line.c <= margin;
  }
  return near ? -1 : 1;
}

// Whether a triangle meets the rectangle of the window at height z: whether the part of it over the
// rectangle has points on both sides.
bool meets_rectangle(const double corners[3][3], const ColumnWindow& window, double z) {
  constexpr int kMost = 8;
  double p[kMost][3], q[kMost][3];
  int count = 3;
  for (int c = 0; c < 3; ++c) std::copy(corners[c], corners[c] + 3, p[c]);
  for (int side = 0; side < 4; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? 1.0 : -1.0;
    const double bound = side % 2 == 0 ? window.low[axis] : window.high[axis];
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const double* from = p[i];
      const double* to = p[i + 1 == count ? 0 : i + 1];
      const double d_from = sign * (from[axis] - bound), d_to = sign * (to[axis] - bound);
      if (d_from >= 0.0) std::copy(from, from + 3, q[kept++]);
      if ((d_from >= 0.0) != (d_to >= 0.0)) {
        const double t = d_from / (d_from - d_to);
        for (int k = 0; k < 3; ++k) q[kept][k] = from[k] + t * (to[k] - from[k]);
        ++kept;
      }
    }
    count = kept;
    for (int i = 0; i < count; ++i) std::copy(q[i], q[i] + 3, p[i]);
  }
  bool below = false, over = false;
  for (int i = 0; i < count; ++i) (p[i][2] < z ? below : over) = true;
  return below && over;
}

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/mesh_columns/column_cells_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {

bool find_leaf_pairs(const ObbTree& a, const Pose& X_CA, const ObbTree& b, const Pose& X_CB,
                     const ColumnWindow& window, int most, CellScratch& scratch) {
  return VOLCONTACT_SIMD_CALL(scratch.path, find_leaf_pairs_wide, a, X_CA, b, X_CB, window, most,
                              scratch);
}

void make_cells(const ObbTree& a, const Pose& X_CA, const ObbTree& b, const Pose& X_CB,
                const ColumnWindow& window, int threads, CellScratch& scratch) {
  constexpr std::size_t kShare = 256;  // leaf pairs that are worth waking a thread for
  const std::size_t pairs = scratch.leaf_pairs.size() / 2;
  if (threads <= 1 || pairs < kShare) {
    scratch.upright = VOLCONTACT_SIMD_CALL(scratch.path, make_cells_wide, a, X_CA, b, X_CB, window,
                                           scratch.leaf_pairs.data(), pairs, scratch.cells);
    return;
  }
  // Each share on its own; put together they are as if they were one.
  const std::size_t shares = (pairs + kShare - 1) / kShare;
  if (scratch.shares.size() < shares) scratch.shares.resize(shares);
  FirstFailure failure;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (std::size_t i = 0; i < shares; ++i) {
    const std::size_t first = i * kShare, count = std::min(pairs - first, kShare);
    failure.guard([&] {
      scratch.shares[i].upright = VOLCONTACT_SIMD_CALL(
          scratch.path, make_cells_wide, a, X_CA, b, X_CB, window,
          scratch.leaf_pairs.data() + 2 * first, count, scratch.shares[i].cells);
    });
  }
  failure.rethrow();
  scratch.upright = false;
  scratch.cells.clear();
  for (std::size_t i = 0; i < shares; ++i) {
    const CellScratch::Share& share = scratch.shares[i];
    scratch.upright |= share.upright;
    scratch.cells.insert(scratch.cells.end(), share.cells.begin(), share.cells.end());
  }
}

void make_cells_below(const ObbTree& a, const Pose& X_CA, CellScratch& scratch) {
  VOLCONTACT_SIMD_CALL(scratch.path, make_cells_below_wide, a, X_CA, scratch);
}

bool make_cells_in_prism(const ObbTree& a, const Pose& X_CA, const ColumnPrism& prism,
                         CellScratch& scratch) {
  return VOLCONTACT_SIMD_CALL(scratch.path, make_cells_in_prism_wide, a, X_CA, prism, scratch);
}

bool meets_level(const ObbTree& tree, const Pose& X_CM, const ColumnWindow& window, double z,
                 CellScratch& scratch) {
  return VOLCONTACT_SIMD_CALL(scratch.path, meets_level_wide, tree, X_CM, window, z, scratch);
}

bool winding(const ObbTree& tree, const Pose& X_CM, CellScratch& scratch, int& number) {
  return VOLCONTACT_SIMD_CALL(scratch.path, winding_wide, tree, X_CM, scratch, number);
}

void add_hits(const ObbTree& tree, const Pose& X_CM, double x, double y, int side,
              CellScratch& scratch, std::vector<ColumnHit>& hits) {
  const Pose X{X_CM.rotation, X_CM.translation - Vec3(x, y, 0.0)};
  VOLCONTACT_SIMD_CALL(scratch.path, add_hits_wide, tree, X, side, scratch, hits);
}

}  // namespace volcontact
