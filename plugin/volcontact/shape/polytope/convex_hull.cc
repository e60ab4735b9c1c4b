// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "volcontact/base/check.h"

namespace volcontact {
namespace {

// Points within this fraction of their extent from one plane are called flat.
constexpr double kFlatness = 1e-12;

// The rounding error of a product a b, exactly, where nothing underflows. Dekker, "A floating-point
// technique for extending the available precision", Numerische Mathematik 18, 1971. std::fma would
// be shorter, but is not exact everywhere: that of mingw-w64 errs in one product of fifty.
double product_error(double a, double b, double product) {
  constexpr double kSplit = 134217729.0;  // 2^27 + 1
  const double a_large = kSplit * a, a_high = a_large - (a_large - a), a_low = a - a_high;
  const double b_large = kSplit * b, b_high = b_large - (b_large - b), b_low = b - b_high;
  return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

// A sum of doubles kept without any rounding error, components ordered by size and not overlapping.
// Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates",
// Discrete & Computational Geometry 18, 1997.
class ExactSum {
 public:
  void add(double x) {
    std::size_t kept = 0;
    for (double part : parts_) {
      const double sum = x + part;
      const double from_part = sum - x;
      const double error = (x - (sum - from_part)) + (part - from_part);
      if (error != 0.0) parts_[kept++] = error;
      x = sum;
    }
    parts_.resize(kept);
    if (x != 0.0) parts_.push_back(x);
  }
  // The product a b c, as the exact sum of four doubles.
  void add_product(double a, double b, double c) {
    const double ab = a * b, ab_error = product_error(a, b, ab);
    for (double factor : {ab, ab_error}) {
      const double product = factor * c;
      add(product);
      add(product_error(factor, c, product));
    }
  }
  int sign() const { return parts_.empty() ? 0 : (parts_.back() > 0.0 ? 1 : -1); }

 private:
  std::vector<double> parts_;
};

void add_determinant(const Vec3& a, const Vec3& b, const Vec3& c, double sign, ExactSum& sum) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum.add_product(sign * a[i], b[j], c[k]);
    sum.add_product(-sign * a[i], b[k], c[j]);
  }
}

struct Face {
  std::array<int, 3> corners;
  std::array<int, 3> neighbors;  // across the edge from corner i to corner i + 1
  std::vector<int> outside;      // points that see this face
  bool alive = true;
};

class Quickhull {
 public:
  explicit Quickhull(const std::vector<Vec3>& points) : points_(points) {
    start();
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      // A face may die while points are added; its points then belong to later faces.
      while (faces_[f].alive && !faces_[f].outside.empty()) add_point(static_cast<int>(f));
    }
  }

  std::vector<std::array<int, 3>> triangles() const {
    std::vector<std::array<int, 3>> result;
    for (const Face& face : faces_) {
      if (face.alive) result.push_back(face.corners);
    }
    return result;
  }

 private:
  // Distance times twice the area: for choosing only, decisions are exact.
  double height(const Face& face, int p) const {
    const Vec3& a = points_[face.corners[0]];
    return (points_[face.corners[1]] - a).cross(points_[face.corners[2]] - a).dot(points_[p] - a);
  }
  bool sees(int p, const Face& face) const {
    return side_of_plane(points_[face.corners[0]], points_[face.corners[1]],
                         points_[face.corners[2]], points_[p]) > 0;
  }

  template <typename Measure>
  int farthest(Measure&& measure) const {
    int best = 0;
    for (int i = 1; i < static_cast<int>(points_.size()); ++i) {
      if (measure(points_[i]) > measure(points_[best])) best = i;
    }
    return best;
  }

  // The first tetrahedron: two points far apart, the farthest from their line, then from their
  // plane.
  void start() {
    const Vec3 first = points_[0];
    const int a = farthest([&](const Vec3& x) { return (x - first).norm(); });
    const Vec3 p = points_[a];
    int b = farthest([&](const Vec3& x) { return (x - p).norm(); });
    const Vec3 along = points_[b] - p;
    const double extent = along.norm();
    int c = farthest([&](const Vec3& x) { return along.cross(x - p).norm(); });
    const Vec3 normal = along.cross(points_[c] - p);
    const int d = farthest([&](const Vec3& x) { return std::abs(normal.dot(x - p)); });
    const double thickness = std::abs(normal.dot(points_[d] - p));
    require(thickness > kFlatness * extent * normal.norm() && normal.norm() > 0.0 &&
                side_of_plane(p, points_[b], points_[c], points_[d]) != 0,
            "convex_polytope: the " + std::to_string(points_.size()) +
                " vertices lie in one plane, so their hull has no volume");
    if (side_of_plane(p, points_[b], points_[c], points_[d]) > 0) std::swap(b, c);
    faces_ = {{{a, b, c}, {1, 2, 3}, {}},
              {{a, d, b}, {3, 2, 0}, {}},
              {{b, d, c}, {1, 3, 0}, {}},
              {{c, d, a}, {2, 1, 0}, {}}};
    std::vector<int> all(points_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    distribute(all, 0);
  }

  // Gives each point to one face, from `first_face` on, that it sees; the others are inside.
  void distribute(const std::vector<int>& candidates, std::size_t first_face) {
    for (int p : candidates) {
      for (std::size_t f = first_face; f < faces_.size(); ++f) {
        if (!sees(p, faces_[f])) continue;
        faces_[f].outside.push_back(p);
        break;
      }
    }
  }

  void add_point(int seed) {
    const std::vector<int>& outside = faces_[seed].outside;
    const int p = *std::max_element(outside.begin(), outside.end(), [&](int i, int j) {
      return height(faces_[seed], i) < height(faces_[seed], j);
    });
    std::vector<int> homeless;
    std::vector<std::pair<int, int>> horizon;  // (face beyond, its slot of the shared edge)
    remove_visible(p, seed, homeless, horizon);

    const std::size_t first = faces_.size();
    std::map<int, int> face_from;  // new face by the first corner of its horizon edge
    for (const auto& [beyond, slot] : horizon) {
      const int f = static_cast<int>(faces_.size());
      const int tail = faces_[beyond].corners[(slot + 1) % 3];
      faces_.push_back({{tail, faces_[beyond].corners[slot], p}, {beyond, -1, -1}, {}});
      faces_[beyond].neighbors[slot] = f;
      face_from[tail] = f;
    }
    for (std::size_t f = first; f < faces_.size(); ++f) {
      const int next = face_from.at(faces_[f].corners[1]);
      faces_[f].neighbors[1] = next;
      faces_[next].neighbors[2] = static_cast<int>(f);
    }
    std::erase(homeless, p);
    distribute(homeless, first);
  }

  // Takes out the faces that `p` sees: a disc, because the tests are exact.
  void remove_visible(int p, int seed, std::vector<int>& homeless,
                      std::vector<std::pair<int, int>>& horizon) {
    std::vector<int> stack{seed};
    faces_[seed].alive = false;
    while (!stack.empty()) {
      const int f = stack.back();
      stack.pop_back();
      homeless.insert(homeless.end(), faces_[f].outside.begin(), faces_[f].outside.end());
      faces_[f].outside.clear();
      for (int beyond : faces_[f].neighbors) {
        Face& other = faces_[beyond];
        if (!other.alive) continue;
        if (sees(p, other)) {
          other.alive = false;
          stack.push_back(beyond);
        } else {
          const auto slot = std::find(other.neighbors.begin(), other.neighbors.end(), f);
          horizon.emplace_back(beyond, static_cast<int>(slot - other.neighbors.begin()));
        }
      }
    }
  }

  const std::vector<Vec3>& points_;
  std::vector<Face> faces_;
};

// The points over a power of two, so that the farthest coordinate is about 1, and rounded to
// multiples of 2^-350, so that no product of three coordinates, nor its rounding error, underflows:
// else a sum would not be exact. A coordinate above 1e-89 of the largest one keeps all its bits.
std::vector<Vec3> scaled(const std::vector<Vec3>& points) {
  double largest = 0.0;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  if (largest == 0.0) return points;
  constexpr int kFinest = 350;
  const int exponent = std::ilogb(largest);
  const auto rounded = [exponent](double x) {
    return std::scalbn(std::nearbyint(std::scalbn(x, kFinest - exponent)), -kFinest);
  };
  std::vector<Vec3> result;
  for (const Vec3& p : points) result.emplace_back(rounded(p.x()), rounded(p.y()), rounded(p.z()));
  return result;
}

}  // namespace

int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double det = u.cross(v).dot(w);
  const Vec3 u_abs = u.cwiseAbs(), v_abs = v.cwiseAbs(), w_abs = w.cwiseAbs();
  const double magnitude = (u_abs.y() * v_abs.z() + u_abs.z() * v_abs.y()) * w_abs.x() +
                           (u_abs.z() * v_abs.x() + u_abs.x() * v_abs.z()) * w_abs.y() +
                           (u_abs.x() * v_abs.y() + u_abs.y() * v_abs.x()) * w_abs.z();
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  if (std::abs(det) > kRounding * magnitude) return det > 0.0 ? 1 : -1;
  // det(b-a, c-a, d-a) = [bcd] - [acd] + [abd] - [abc], without a difference that could round.
  ExactSum sum;
  add_determinant(b, c, d, 1.0, sum);
  add_determinant(a, c, d, -1.0, sum);
  add_determinant(a, b, d, 1.0, sum);
  add_determinant(a, b, c, -1.0, sum);
  return sum.sign();
}

std::vector<std::array<int, 3>> convex_hull(const std::vector<Vec3>& points) {
  require(points.size() >= 4,
          "convex_polytope: needs at least 4 vertices, got " + std::to_string(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    require(points[i].allFinite(),
            "convex_polytope: vertex " + std::to_string(i) + " is not finite");
  }
  const std::vector<Vec3> tame = scaled(points);
  return Quickhull(tame).triangles();
}

}  // namespace volcontact
