// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/columns/cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "volcontact/pair/columns/leaf_cache.h"

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

// Keeps the part on the positive side of a line. Sutherland and Hodgman, Comm. ACM 17(1), 1974.
void cut(const Polygon& in, const Line& line, signed char label, Polygon& out) {
  int count = 0;
  int last = in.count - 1;
  double from_x = in.x[last], from_y = in.y[last], from = line(from_x, from_y);
  signed char from_label = in.label[last];
  for (int i = 0; i < in.count; ++i) {
    const double to_x = in.x[i], to_y = in.y[i], to = line(to_x, to_y);
    if ((from >= 0.0) != (to >= 0.0)) {
      const double t = from / (from - to);
      out.x[count] = from_x + t * (to_x - from_x);
      out.y[count] = from_y + t * (to_y - from_y);
      out.label[count++] = from >= 0.0 ? label : from_label;
    }
    if (to >= 0.0) {
      out.x[count] = to_x;
      out.y[count] = to_y;
      out.label[count++] = in.label[i];
    }
    from_x = to_x;
    from_y = to_y;
    from = to;
    from_label = in.label[i];
  }
  out.count = count;
}

// The half-edge of the mesh that edge e of a face, counterclockwise from above, lies on.
signed char half_edge(const ColumnFace& face, int e) {
  return static_cast<signed char>(face.sign > 0 ? e : 2 - e);
}

// A cell but for its corners.
ColumnCell& add_cell_of(const ColumnFace& f, int slot_f, const ColumnFace& g, int slot_g, int count,
                        std::vector<ColumnCell>& cells) {
  ColumnCell& cell = cells.emplace_back();
  cell.f = slot_f;
  cell.g = slot_g;
  cell.sign_f = static_cast<signed char>(f.sign);
  cell.sign_g = static_cast<signed char>(g.sign);
  cell.count = static_cast<signed char>(count);
  cell.labels = 0;
  cell.walls = 0;
  cell.slope_f[0] = f.slope_x;
  cell.slope_f[1] = f.slope_y;
  cell.slope_g[0] = g.slope_x;
  cell.slope_g[1] = g.slope_y;
  return cell;
}

void finish(const Polygon& polygon, const ColumnFace& f, int slot_f, const ColumnFace& g,
            int slot_g, std::vector<ColumnCell>& cells) {
  if (polygon.count > kLanes) return;  // bent by rounding: it has no area
  ColumnCell& cell = add_cell_of(f, slot_f, g, slot_g, polygon.count, cells);
  const double dx = g.slope_x - f.slope_x, dy = g.slope_y - f.slope_y, d = g.level - f.level;
  const double mx = 0.5 * (g.slope_x + f.slope_x), my = 0.5 * (g.slope_y + f.slope_y),
               m = 0.5 * (g.level + f.level);
  double twice_area = 0.0;
  for (int i = 0; i < polygon.count; ++i) {
    const double x = polygon.x[i], y = polygon.y[i];
    cell.x[i] = x;
    cell.y[i] = y;
    cell.delta[i] = std::max(0.0, dx * x + dy * y + d);
    cell.middle[i] = mx * x + my * y + m;
    cell.label[i] = polygon.label[i];
    cell.labels = static_cast<unsigned char>(cell.labels | 1u << polygon.label[i]);
    if (i >= 2) {
      twice_area += (polygon.x[i - 1] - polygon.x[0]) * (y - polygon.y[0]) -
                    (polygon.y[i - 1] - polygon.y[0]) * (x - polygon.x[0]);
    }
  }
  cell.area = 0.5 * twice_area;
}

// Cuts away where g is below f. Rounding leaves the sign of the height difference open where the
// faces coincide: there is nothing to gain from such a cut, and nothing to lose.
bool cut_by_height(const ColumnFace& f, const ColumnFace& g, Polygon (&polygon)[2], int& current) {
  const Line gap{g.slope_x - f.slope_x, g.slope_y - f.slope_y, g.level - f.level};
  const Polygon& p = polygon[current];
  double low = kInfinity, high = -kInfinity;
  for (int i = 0; i < p.count; ++i) {
    const double value = gap(p.x[i], p.y[i]);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(high > 0.0)) return false;
  if (low < 0.0) {
    cut(polygon[current], gap, kCrossing, polygon[1 - current]);
    current = 1 - current;
  }
  return polygon[current].count >= 3;
}

void take_outline(const ColumnFace& f, Polygon& polygon) {
  polygon.count = 3;
  for (int i = 0; i < 3; ++i) {
    polygon.x[i] = f.x[i];
    polygon.y[i] = f.y[i];
    polygon.label[i] = half_edge(f, i);
  }
}

void add_cell(const ColumnFace& f, int slot_f, const ColumnFace& g, int slot_g,
              std::vector<ColumnCell>& cells) {
  Line side[3];
  bool cuts[3];
  for (int e = 0; e < 3; ++e) {
    side[e] = line_of(g, e);
    const double v0 = side[e](f.x[0], f.y[0]), v1 = side[e](f.x[1], f.y[1]),
                 v2 = side[e](f.x[2], f.y[2]);
    if (!(std::max(v0, std::max(v1, v2)) > 0.0)) return;
    cuts[e] = std::min(v0, std::min(v1, v2)) < 0.0;
  }
  for (int e = 0; e < 3; ++e) {
    if (!(line_of(f, e).highest(g) > 0.0)) return;
  }
  Polygon polygon[2];
  take_outline(f, polygon[0]);
  int current = 0;
  for (int e = 0; e < 3; ++e) {
    if (!cuts[e]) continue;
    cut(polygon[current], side[e], static_cast<signed char>(3 + half_edge(g, e)),
        polygon[1 - current]);
    current = 1 - current;
    if (polygon[current].count < 3) return;
  }
  if (!cut_by_height(f, g, polygon, current)) return;
  finish(polygon[current], f, slot_f, g, slot_g, cells);
}

void add_cell_below(const ColumnFace& f, int slot_f, std::vector<ColumnCell>& cells) {
  const ColumnFace ground{{}, {}, 0.0, 0.0, 0.0, 1};
  double depth[3];
  for (int i = 0; i < 3; ++i) depth[i] = -(f.slope_x * f.x[i] + f.slope_y * f.y[i] + f.level);
  if (std::min(depth[0], std::min(depth[1], depth[2])) >= 0.0) {  // most of them
    ColumnCell& cell = add_cell_of(f, slot_f, ground, -1, 3, cells);
    for (int i = 0; i < 3; ++i) {
      cell.x[i] = f.x[i];
      cell.y[i] = f.y[i];
      cell.delta[i] = depth[i];
      cell.middle[i] = -0.5 * depth[i];
      cell.label[i] = half_edge(f, i);
    }
    cell.labels = 0b111;
    cell.area =
        0.5 * ((f.x[1] - f.x[0]) * (f.y[2] - f.y[0]) - (f.y[1] - f.y[0]) * (f.x[2] - f.x[0]));
    return;
  }
  Polygon polygon[2];
  take_outline(f, polygon[0]);
  int current = 0;
  if (!cut_by_height(f, ground, polygon, current)) return;
  finish(polygon[current], f, slot_f, ground, -1, cells);
}

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

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/columns/cells_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {

bool find_leaf_pairs(const ObbTree& a, const Pose& X_CA, const ObbTree& b, const Pose& X_CB,
                     const ColumnWindow& window, int most, CellScratch& scratch) noexcept {
  return VOLCONTACT_SIMD_CALL(scratch.path, find_leaf_pairs_wide, a, X_CA, b, X_CB, window, most,
                              scratch);
}

void make_cells(const ObbTree& a, const Pose& X_CA, const ObbTree& b, const Pose& X_CB,
                const ColumnWindow& window, int threads, CellScratch& scratch) noexcept {
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
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (std::size_t i = 0; i < shares; ++i) {
    const std::size_t first = i * kShare, count = std::min(pairs - first, kShare);
    scratch.shares[i].upright =
        VOLCONTACT_SIMD_CALL(scratch.path, make_cells_wide, a, X_CA, b, X_CB, window,
                             scratch.leaf_pairs.data() + 2 * first, count, scratch.shares[i].cells);
  }
  scratch.upright = false;
  scratch.cells.clear();
  for (std::size_t i = 0; i < shares; ++i) {
    const CellScratch::Share& share = scratch.shares[i];
    scratch.upright |= share.upright;
    scratch.cells.insert(scratch.cells.end(), share.cells.begin(), share.cells.end());
  }
}

void make_cells_below(const ObbTree& a, const Pose& X_CA, CellScratch& scratch) noexcept {
  VOLCONTACT_SIMD_CALL(scratch.path, make_cells_below_wide, a, X_CA, scratch);
}

bool make_cells_in_prism(const ObbTree& a, const Pose& X_CA, const ColumnPrism& prism,
                         CellScratch& scratch) noexcept {
  return VOLCONTACT_SIMD_CALL(scratch.path, make_cells_in_prism_wide, a, X_CA, prism, scratch);
}

bool meets_level(const ObbTree& tree, const Pose& X_CM, const ColumnWindow& window, double z,
                 CellScratch& scratch) noexcept {
  return VOLCONTACT_SIMD_CALL(scratch.path, meets_level_wide, tree, X_CM, window, z, scratch);
}

bool winding(const ObbTree& tree, const Pose& X_CM, CellScratch& scratch, int& number) noexcept {
  return VOLCONTACT_SIMD_CALL(scratch.path, winding_wide, tree, X_CM, scratch, number);
}

void add_hits(const ObbTree& tree, const Pose& X_CM, double x, double y, int side,
              CellScratch& scratch, std::vector<ColumnHit>& hits) noexcept {
  const Pose X{X_CM.rotation, X_CM.translation - Vec3(x, y, 0.0)};
  VOLCONTACT_SIMD_CALL(scratch.path, add_hits_wide, tree, X, side, scratch, hits);
}

}  // namespace volcontact
