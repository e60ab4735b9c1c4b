// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/picture/overlap_surface.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "volcontact/base/symmetric_eigen.h"

namespace volcontact {
namespace {

using Column = OverlapSurface::Column;

constexpr int kMostWaySteps = 100;   // towards one end of a column
constexpr int kHalvings = 7;         // of a grid step, to find the rim
constexpr int kCoarse = 24;          // columns across, to find how far the site reaches
constexpr double kReach = 3.2;       // standard deviations; a box has 1.7, a disc 2, a triangle 2.8
constexpr double kSharpness = 1e-3;  // error of the ends, in mean thicknesses

double distance_to(const Shape& shape, const Vec3& p) {
  return std::visit([&](const auto& solid) { return solid.signed_distance(p); }, shape);
}

// Where the columns stand: the plane through the centroid, normal to the contact.
struct Frame {
  Vec3 center, u, v, normal;
  double half_u, half_v, half_height;  // [m]
};

// Axes along which the site is longest and shortest, seen along the normal.
Frame frame_of(const VolumeMetrics& site) {
  const Mat3 covariance = site.second_moment() / site.volume;
  Vec3 normal = site.normal();
  if (normal.isZero()) {  // contained: across its thinnest direction
    normal = symmetric_eigen(covariance).vectors.col(0);
  }
  const Mat3 basis = basis_with_z(normal);
  const Mat2 flat = basis.leftCols<2>().transpose() * covariance * basis.leftCols<2>();
  const auto axes = symmetric_eigen(flat);
  const auto spread = [&](int i) { return kReach * std::sqrt(std::max(axes.values[i], 0.0)); };
  const Vec3 u = basis.leftCols<2>() * axes.vectors.col(1);
  const double thick = 4.0 * std::sqrt(std::max(normal.dot(covariance * normal), 0.0));
  return {site.centroid,
          u,
          normal.cross(u),
          normal,
          spread(1),
          spread(0),
          1.02 * std::max(site.depth, thick)};
}

// Finds columns by steps as long as the distance to the surface of the overlap.
class Probe {
 public:
  Probe(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB,
        const VolumeMetrics& site, const Frame& frame)
      : a_(a), b_(b), X_AW_(X_WA.inverse()), X_BW_(X_WB.inverse()), frame_(frame) {
    const double patch = std::max(site.area_vector.norm(), 1e-3 * site.area);
    const double thickness = patch > 0.0 ? site.volume / patch : frame.half_height;
    close_ = kSharpness * std::min(thickness, frame.half_height);
  }

  // The column above the point (u, v) of the plane, if it meets the overlap.
  std::optional<Column> column(double u, double v) const {
    const Vec3 foot = frame_.center + u * frame_.u + v * frame_.v;
    const auto low = end(foot - frame_.half_height * frame_.normal, frame_.normal);
    if (!low) return std::nullopt;
    const auto high = end(foot + frame_.half_height * frame_.normal, -frame_.normal);
    if (!high) return std::nullopt;
    return Column{*low, *high};
  }

 private:
  std::optional<Vec3> end(const Vec3& start, const Vec3& direction) const {
    double way = 0.0;
    for (int step = 0; step < kMostWaySteps && way <= 2.0 * frame_.half_height; ++step) {
      const Vec3 p = start + way * direction;
      const double gap = std::max(distance_to(a_, X_AW_ * p), distance_to(b_, X_BW_ * p));
      if (gap <= close_) return p;
      way += gap;
    }
    return std::nullopt;
  }

  const Shape& a_;
  const Shape& b_;
  Pose X_AW_, X_BW_;
  Frame frame_;
  double close_ = 0.0;  // [m]
};

// Columns at the nodes of a grid, and where its lines cross the rim, joined cell by cell.
class Grid {
 public:
  Grid(const Probe& probe, double low_u, double high_u, double low_v, double high_v, int cells)
      : probe_(probe),
        low_u_(low_u),
        low_v_(low_v),
        step_u_((high_u - low_u) / cells),
        step_v_((high_v - low_v) / cells),
        cells_(cells),
        nodes_(static_cast<std::size_t>((cells + 1) * (cells + 1)), -1),
        crossings_(2 * nodes_.size(), -1) {
    for (int j = 0; j <= cells_; ++j) {
      for (int i = 0; i <= cells_; ++i) {
        if (const auto found = probe_.column(u_of(i), v_of(j))) nodes_[at(i, j)] = add(*found);
      }
    }
  }

  // Narrows the limits of the grid to one cell around what was found; false if that is nothing.
  bool tighten(double& low_u, double& high_u, double& low_v, double& high_v) const {
    int first_i = cells_, last_i = 0, first_j = cells_, last_j = 0;
    for (int j = 0; j <= cells_; ++j) {
      for (int i = 0; i <= cells_; ++i) {
        if (nodes_[at(i, j)] < 0) continue;
        first_i = std::min(first_i, i), last_i = std::max(last_i, i);
        first_j = std::min(first_j, j), last_j = std::max(last_j, j);
      }
    }
    if (first_i > last_i) return false;
    low_u = u_of(first_i - 1), high_u = u_of(last_i + 1);
    low_v = v_of(first_j - 1), high_v = v_of(last_j + 1);
    return true;
  }

  OverlapSurface surface() && {
    for (int j = 0; j < cells_; ++j) {
      for (int i = 0; i < cells_; ++i) add_cell(i, j);
    }
    return std::move(surface_);
  }

 private:
  struct Node {
    int i, j;
  };

  double u_of(double i) const { return low_u_ + i * step_u_; }
  double v_of(double j) const { return low_v_ + j * step_v_; }
  std::size_t at(int i, int j) const { return static_cast<std::size_t>(j * (cells_ + 1) + i); }
  int inside(Node n) const { return nodes_[at(n.i, n.j)]; }
  int add(const Column& column) {
    surface_.columns.push_back(column);
    return static_cast<int>(surface_.columns.size()) - 1;
  }

  // The last column of the line from p to q, of which one is inside.
  int crossing(Node p, Node q) {
    const Node first = p.i + p.j < q.i + q.j ? p : q;
    int& known = crossings_[2 * at(first.i, first.j) + (p.i == q.i ? 1 : 0)];
    if (known >= 0) return known;
    if (inside(p) < 0) std::swap(p, q);
    Column last = surface_.columns[static_cast<std::size_t>(inside(p))];
    double in = 0.0, out = 1.0;
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double t = 0.5 * (in + out);
      const auto found = probe_.column(u_of(p.i + t * (q.i - p.i)), v_of(p.j + t * (q.j - p.j)));
      (found ? in : out) = t;
      if (found) last = *found;
    }
    return known = add(last);
  }

  // Walks around a cell, counterclockwise; from where it leaves the overlap to where it enters it
  // again there is the rim.
  void add_cell(int i, int j) {
    const std::array<Node, 4> corners{Node{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}};
    const std::array<bool, 4> is_border{j == 0, i + 1 == cells_, j + 1 == cells_, i == 0};
    std::array<int, 8> outline{};
    std::size_t count = 0;
    std::array<bool, 8> leaves{};
    for (std::size_t k = 0; k < 4; ++k) {
      const Node p = corners[k], q = corners[(k + 1) % 4];
      const bool starts = inside(p) >= 0, ends = inside(q) >= 0;
      if (!starts && !ends) continue;
      const int cross = starts != ends ? crossing(p, q) : -1;
      if (starts) outline[count++] = inside(p);
      if (cross >= 0) leaves[count] = starts, outline[count++] = cross;
      if (is_border[k]) {
        surface_.rim.push_back({starts ? inside(p) : cross, ends ? inside(q) : cross});
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (leaves[k]) surface_.rim.push_back({outline[k], outline[(k + 1) % count]});
    }
    for (std::size_t k = 2; k < count; ++k) {
      surface_.triangles.push_back({outline[0], outline[k - 1], outline[k]});
    }
  }

  const Probe& probe_;
  double low_u_, low_v_, step_u_, step_v_;  // [m]
  int cells_;
  std::vector<int> nodes_, crossings_;  // columns of them, or -1
  OverlapSurface surface_;
};

}  // namespace

OverlapSurface overlap_surface(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB,
                               const VolumeMetrics& site, int resolution) {
  if (!site.touching() || !is_finite(site)) return {};
  const Frame frame = frame_of(site);
  const Probe probe(a, X_WA, b, X_WB, site, frame);
  double high_u = frame.half_u, high_v = frame.half_v, low_u = -high_u, low_v = -high_v;
  if (!Grid(probe, low_u, high_u, low_v, high_v, kCoarse).tighten(low_u, high_u, low_v, high_v)) {
    return {};
  }
  return Grid(probe, low_u, high_u, low_v, high_v, std::max(resolution, 2)).surface();
}

}  // namespace volcontact
