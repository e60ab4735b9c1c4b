// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/column_sums.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

// 11 moments of the columns, then area vector and moment of their ends on A's surface.
constexpr int kSums = 17;

// Triangles of which the moments are still to be added.
struct ColumnTriangles {
  static constexpr int kMost = 8 * kLanes;
  alignas(64) double x[3][kMost], y[3][kMost], middle[3][kMost], delta[3][kMost], area[kMost];
  alignas(64) double slope_x[kMost], slope_y[kMost];  // of A's face
  alignas(64) double area_of_a[kMost];                // 0 where the face is not A's surface here
  int count = 0;
};

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/mesh_columns/column_sums_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {
namespace {

// Integral over an edge of unit length of the product of two functions linear along it.
double edge_product(double a0, double a1, double b0, double b1) {
  return (2.0 * (a0 * b0 + a1 * b1) + a0 * b1 + a1 * b0) / 6.0;
}

class Summation {
 public:
  Summation(const ColumnSurface& a, const ColumnSurface& b, SimdPath path)
      : surfaces_{&a, &b}, path_(path) {}

  // The columns of a cell between its two faces, or from height 0 to one of them.
  void add_columns(const ColumnCell& cell, bool from_f, bool to_g, bool through) {
    const double weight = -cell.sign_f * cell.sign_g;
    const bool whole = from_f && to_g;
    double part_delta[kLanes], part_middle[kLanes];
    const double* delta = whole ? cell.delta : part_delta;
    const double* middle = whole ? cell.middle : part_middle;
    for (int i = 0; i < cell.count; ++i) {
      const double half = 0.5 * cell.delta[i];
      const double low = from_f ? cell.middle[i] - half : 0.0;
      const double high = to_g ? cell.middle[i] + half : 0.0;
      if (through) depth_ = std::max(depth_, cell.delta[i]);
      part_delta[i] = high - low;
      part_middle[i] = 0.5 * (low + high);
    }
    if (triangles_.count + kLanes > ColumnTriangles::kMost) flush();
    for (int i = 1; i + 1 < cell.count; ++i) {
      const double area = 0.5 * ((cell.x[i] - cell.x[0]) * (cell.y[i + 1] - cell.y[0]) -
                                 (cell.y[i] - cell.y[0]) * (cell.x[i + 1] - cell.x[0]));
      const int k = triangles_.count++;
      triangles_.area[k] = weight * area;
      triangles_.area_of_a[k] = from_f ? weight * area : 0.0;
      triangles_.slope_x[k] = cell.slope_f[0];
      triangles_.slope_y[k] = cell.slope_f[1];
      const int corner[3] = {0, i, i + 1};
      for (int c = 0; c < 3; ++c) {
        triangles_.x[c][k] = cell.x[corner[c]];
        triangles_.y[c][k] = cell.y[corner[c]];
        triangles_.middle[c][k] = middle[corner[c]];
        triangles_.delta[c][k] = delta[corner[c]];
      }
      absolute_ += area / 3.0 * std::abs(delta[0] + delta[i] + delta[i + 1]);
    }
  }

  // A's face of a cell; its area vector and moment are those of its columns' lower ends.
  void add_surface_of_a(const ColumnCell& cell) {
    const double ax = cell.slope_f[0], ay = cell.slope_f[1];
    const double steepness = 1.0 + ax * ax + ay * ay;
    sum_.moments.area += cell.sign_g * cell.area * std::sqrt(steepness);
    sum_.seen += cell.area * std::sqrt(steepness);
  }

  // The upright walls of A on the edges of f. Across an edge with a cell on either side the surface
  // goes on: there is no wall.
  void add_walls_of_a(const ColumnCell& cell) {
    const double weight = -cell.sign_f * cell.sign_g;
    for (int i = 0; i < cell.count; ++i) {
      if (cell.label[i] >= 3 || (cell.walls & 1u << cell.label[i]) == 0) continue;
      const int j = i + 1 == cell.count ? 0 : i + 1;
      const double dx = cell.x[j] - cell.x[i], dy = cell.y[j] - cell.y[i];
      const double height = 0.5 * (cell.delta[i] + cell.delta[j]);
      const double moment =
          edge_product(cell.delta[i], cell.delta[j], cell.middle[i], cell.middle[j]);
      sum_.moments.area_vector += weight * height * Vec3(dy, -dx, 0.0);
      sum_.moments.area_moment +=
          weight * Vec3(moment * dx, moment * dy,
                        -edge_product(cell.delta[i], cell.delta[j], cell.x[i], cell.x[j]) * dx -
                            edge_product(cell.delta[i], cell.delta[j], cell.y[i], cell.y[j]) * dy);
      sum_.moments.area += weight * height * wall(0, cell.f, cell.label[i], dx, dy);
    }
  }

  void add_surface_of_b(const ColumnCell& cell) {
    const double gx = cell.slope_g[0], gy = cell.slope_g[1];
    const double steepness = 1.0 + gx * gx + gy * gy;
    sum_.moments.counter_area -= cell.sign_f * cell.area * std::sqrt(steepness);
    sum_.counter_vector -= cell.sign_f * cell.sign_g * cell.area * Vec3(-gx, -gy, 1.0);
    sum_.seen += cell.area * std::sqrt(steepness);
  }

  void add_walls_of_b(const ColumnCell& cell) {
    const double weight = -cell.sign_f * cell.sign_g;
    for (int i = 0; i < cell.count; ++i) {
      const int label = cell.label[i];
      if (label < 3 || (cell.walls & 1u << label) == 0 || label == kCrossing) continue;
      const int j = i + 1 == cell.count ? 0 : i + 1;
      const double dx = cell.x[j] - cell.x[i], dy = cell.y[j] - cell.y[i];
      const double height = 0.5 * (cell.delta[i] + cell.delta[j]);
      sum_.counter_vector += weight * height * Vec3(dy, -dx, 0.0);
      sum_.moments.counter_area += weight * height * wall(1, cell.g, label - 3, dx, dy);
    }
  }

  CellSum finish() {
    flush();
    double totals[kSums];
    VOLCONTACT_SIMD_CALL(path_, total_wide, lanes_, totals);
    MomentSum& m = sum_.moments;
    m.volume = totals[0] / 3.0;
    m.first = Vec3(totals[1], totals[2], totals[3]) / 12.0;
    m.second = {totals[4], totals[7], totals[8], totals[7], totals[5],
                totals[9], totals[8], totals[9], totals[6]};
    m.second /= 60.0;
    m.area_vector += Vec3(totals[11], totals[12], -totals[13]);
    m.area_moment += Vec3(totals[14], totals[15], totals[16]) / 3.0;
    sum_.energy = totals[10] / 24.0;
    sum_.depth = depth_;
    sum_.absolute = absolute_;
    return sum_;
  }

 private:
  void flush() {
    const int full = (triangles_.count + kLanes - 1) / kLanes * kLanes;
    for (int k = triangles_.count; k < full; ++k) {
      triangles_.area[k] = triangles_.area_of_a[k] = 0.0;
      triangles_.slope_x[k] = triangles_.slope_y[k] = 0.0;
      for (int c = 0; c < 3; ++c) {
        triangles_.x[c][k] = triangles_.y[c][k] = 0.0;
        triangles_.middle[c][k] = triangles_.delta[c][k] = 0.0;
      }
    }
    VOLCONTACT_SIMD_CALL(path_, add_moments_wide, triangles_, lanes_);
    triangles_.count = 0;
  }

  // Length of the edge (dx, dy) of a cell when the face across half-edge `edge` stands upright,
  // with the sign of that face's outward normal along the outward normal of the edge; else 0.
  double wall(int side, int slot, int edge, double dx, double dy) const {
    const ObbTree* tree = surfaces_[side]->tree;
    if (tree == nullptr) return 0.0;
    const int other = tree->twins[3 * slot + edge] / 3;
    const Vec3 origin = tree->corner(other, 0);
    const Vec3 normal = surfaces_[side]->X_CM->rotation *
                        (tree->corner(other, 1) - origin).cross(tree->corner(other, 2) - origin);
    if (!(std::abs(normal.z()) <= kUpright * normal.norm())) return 0.0;
    const double length = std::hypot(dx, dy);
    return normal.x() * dy - normal.y() * dx >= 0.0 ? length : -length;
  }

  static constexpr double kUpright = 1e-9;

  const ColumnSurface* surfaces_[2];
  const SimdPath path_;
  ColumnTriangles triangles_;
  alignas(64) double lanes_[kSums][kLanes] = {};
  CellSum sum_;
  double depth_ = 0.0, absolute_ = 0.0;
};

}  // namespace

CellSum& CellSum::operator+=(const CellSum& other) {
  moments += other.moments;
  counter_vector += other.counter_vector;
  energy += other.energy;
  depth = std::max(depth, other.depth);
  absolute += other.absolute;
  seen += other.seen;
  return *this;
}

CellSum sum_region(int region, const std::vector<ColumnCell>& cells,
                   const std::vector<CellRegion>& region_of, const ColumnSurface& a,
                   const ColumnSurface& b, SimdPath path) {
  Summation summation(a, b, path);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool in_f = region_of[i].of_f == region, in_g = region_of[i].of_g == region;
    if (region_of[i].of_wall_f == region) summation.add_walls_of_a(cells[i]);
    if (region_of[i].of_wall_g == region) summation.add_walls_of_b(cells[i]);
    if (in_f || in_g) summation.add_columns(cells[i], in_f, in_g, region_of[i].through);
    if (in_f) summation.add_surface_of_a(cells[i]);
    if (in_g) summation.add_surface_of_b(cells[i]);
  }
  return summation.finish();
}

double energy_of(const std::vector<ColumnCell>& cells) {
  double sum = 0.0;
  for (const ColumnCell& cell : cells) {
    for (int i = 1; i + 1 < cell.count; ++i) {
      const double area = (cell.x[i] - cell.x[0]) * (cell.y[i + 1] - cell.y[0]) -
                          (cell.y[i] - cell.y[0]) * (cell.x[i + 1] - cell.x[0]);
      const double a = cell.delta[0], b = cell.delta[i], c = cell.delta[i + 1];
      sum -= cell.sign_f * cell.sign_g * area * ((a + b + c) * (a + b + c) + a * a + b * b + c * c);
    }
  }
  return sum / 48.0;
}

}  // namespace volcontact
