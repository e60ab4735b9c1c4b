// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/convex/gjk.h"

#include <algorithm>
#include <limits>

namespace volcontact {
namespace {

constexpr int kMaxSteps = 64;
constexpr double kTouch = 1e-15;      // relative distance below which the solids touch
constexpr double kLeanOnFace = 1e-7;  // of a normal, to look for the edge of its face
constexpr int kLayerHalvings = 12;    // of the depth that is looked for
constexpr double kLayerRoom = 2.0;    // below a face, by how deep the layer can be
constexpr double kNearEnough = 0.1;   // of a ball's depth in a solid, to which it is known

// A point of the difference A - B, and the point of A it comes from.
struct Corner {
  Vec3 w, a;
};

// The place of a simplex nearest the origin, as weights of its corners.
struct Nearest {
  double distance2 = std::numeric_limits<double>::infinity();
  Vec3 place = Vec3::Zero();
  double weights[4] = {};

  void offer(const Vec3& p, const double (&new_weights)[4]) {
    const double d2 = p.squaredNorm();
    if (!(d2 < distance2)) return;
    distance2 = d2;
    place = p;
    std::copy(new_weights, new_weights + 4, weights);
  }
};

void offer_corner(const Corner* s, int i, Nearest& nearest) {
  double weights[4] = {};
  weights[i] = 1.0;
  nearest.offer(s[i].w, weights);
}

void offer_edge(const Corner* s, int i, int j, Nearest& nearest) {
  const Vec3 along = s[j].w - s[i].w;
  const double length2 = along.squaredNorm();
  const double x = -s[i].w.dot(along);
  if (!(x > 0.0 && x < length2)) return;
  double weights[4] = {};
  weights[j] = x / length2;
  weights[i] = 1.0 - weights[j];
  nearest.offer(s[i].w + weights[j] * along, weights);
}

void offer_triangle(const Corner* s, int i, int j, int k, Nearest& nearest) {
  const Vec3 p = s[i].w, e = s[j].w - p, f = s[k].w - p;
  const Vec3 normal = e.cross(f);
  const double n2 = normal.squaredNorm();
  if (!(n2 > 0.0)) return;
  const double at_j = f.cross(p).dot(normal) / n2, at_k = p.cross(e).dot(normal) / n2;
  if (!(at_j > 0.0 && at_k > 0.0 && at_j + at_k < 1.0)) return;
  double weights[4] = {};
  weights[i] = 1.0 - at_j - at_k;
  weights[j] = at_j;
  weights[k] = at_k;
  nearest.offer(normal * (normal.dot(p) / n2), weights);
}

// Whether the origin is in the tetrahedron; then `weights` says where.
bool encloses(const Corner* s, double (&weights)[4]) {
  const Vec3 e = s[1].w - s[0].w, f = s[2].w - s[0].w, g = s[3].w - s[0].w;
  const double volume = e.dot(f.cross(g));
  if (volume == 0.0) return false;
  const Vec3 p = -s[0].w;
  weights[1] = p.dot(f.cross(g)) / volume;
  weights[2] = e.dot(p.cross(g)) / volume;
  weights[3] = e.dot(f.cross(p)) / volume;
  weights[0] = 1.0 - weights[1] - weights[2] - weights[3];
  for (double weight : weights) {
    if (!(weight >= 0.0)) return false;
  }
  return true;
}

// Every face of the simplex that has the newest corner, the last one.
Nearest nearest_place(const Corner* s, int count) {
  Nearest nearest;
  const int last = count - 1;
  offer_corner(s, last, nearest);
  for (int i = 0; i < last; ++i) {
    offer_edge(s, i, last, nearest);
    for (int j = 0; j < i; ++j) offer_triangle(s, j, i, last, nearest);
  }
  return nearest;
}

// Drops the corners that the nearest place does not need; how many are left, in their order.
int keep_used(Corner* s, int count, const Nearest& nearest) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    if (nearest.weights[i] != 0.0) s[kept++] = s[i];
  }
  return kept;
}

}  // namespace

Vec3 nearest_in_hull(const std::vector<Vec3>& points) {
  Corner corners[4];
  corners[0].w = points[0];
  int count = 1;
  Vec3 v = points[0];
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto farthest =
        std::min_element(points.begin(), points.end(),
                         [&](const Vec3& a, const Vec3& b) { return a.dot(v) < b.dot(v); });
    if (!(v.squaredNorm() - farthest->dot(v) > kTouch * v.squaredNorm())) return v;
    corners[count++].w = *farthest;
    double weights[4];
    if (count == 4 && encloses(corners, weights)) return Vec3::Zero();
    const Nearest nearest = nearest_place(corners, count);
    if (!(nearest.distance2 < v.squaredNorm())) return v;
    count = keep_used(corners, count, nearest);
    v = nearest.place;
  }
  return v;
}

BallGap ball_gap(const ConvexView& solid, const Pose& X_AS, const Vec3& center, double radius) {
  Corner corners[4];
  double weights[4];
  int count = 1;
  corners[0].w = solid.middle(X_AS) - center;
  Vec3 v = corners[0].w;  // the place of the simplex nearest the center
  double deepest = -std::numeric_limits<double>::infinity();  // bound of the distance from below
  BallGap gap{false, Vec3::UnitZ(), 0.0, center};
  for (int step = 0; step < kMaxSteps; ++step) {
    const double distance = v.norm();
    if (!(distance > kTouch * radius)) break;
    const Vec3 normal = v / -distance;
    const Vec3 w = solid.support(X_AS, normal) - center;
    const double least = -normal.dot(w);
    if (least > deepest) {
      deepest = least;
      gap.normal = normal;
      gap.offset = normal.dot(center) - least;
      if (least > radius) {
        gap.apart = true;
        return gap;
      }
    }
    if (distance - deepest <= kNearEnough * (radius - distance)) break;
    corners[count++].w = w;
    if (count == 4 && encloses(corners, weights)) {
      v.setZero();
      break;
    }
    const Nearest nearest = nearest_place(corners, count);
    if (!(nearest.distance2 < v.squaredNorm())) break;
    count = keep_used(corners, count, nearest);
    v = nearest.place;
  }
  gap.place = center + v;
  return gap;
}

namespace {

// `support(direction)` is the corner of the difference in a direction. Where the solids have a
// point in common it is the sum of the corners' `a` with these weights.
template <typename Support>
bool find_common_point(const Support& support, const Vec3& first, Vec3& point) {
  Corner corners[4];
  double weights[4] = {1.0, 0.0, 0.0, 0.0};
  int count = 1;
  corners[0] = support(first);
  Vec3 v = corners[0].w;  // the place of the simplex nearest the origin
  double size = v.norm();
  const auto common_point = [&] {
    point = Vec3::Zero();
    for (int i = 0; i < count; ++i) point += weights[i] * corners[i].a;
    return true;
  };
  for (int step = 0; step < kMaxSteps; ++step) {
    if (!(v.norm() > kTouch * size)) return common_point();
    corners[count++] = support(-v);
    const Vec3& w = corners[count - 1].w;
    size = std::max(size, w.norm());
    if (v.dot(w) > 0.0) return false;  // the plane through the origin normal to v lies between them
    if (count == 4 && encloses(corners, weights)) return common_point();
    const Nearest nearest = nearest_place(corners, count);
    if (!(nearest.distance2 < v.squaredNorm())) {  // no progress left in the digits
      --count;
      return common_point();
    }
    count = keep_used(corners, count, nearest);
    std::remove_copy(nearest.weights, nearest.weights + 4, weights, 0.0);
    v = nearest.place;
  }
  return common_point();
}

}  // namespace

bool find_common_point(const ConvexView& a, const ConvexView& b, const Pose& X_AB, Vec3& point) {
  const auto support = [&](const Vec3& direction) {
    const Vec3 of_a = a.support(Pose{}, direction);
    return Corner{of_a - b.support(X_AB, -direction), of_a};
  };
  return find_common_point(
      support, X_AB.translation.squaredNorm() > 0.0 ? X_AB.translation : Vec3(Vec3::UnitZ()),
      point);
}

bool find_common_point_in_layer(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                                const FlushFaces& faces, Vec3& point) {
  // The faces with as much below them as the layer is thick, which is all that can be met.
  const Vec3& n = faces.normal_a;
  const Vec3 lean_b = faces.normal_b - n * n.dot(faces.normal_b);
  const double scale = faces.size / faces.depth;
  double apart = 0.0;  // how far B is moved out, for a point that does not only touch
  const auto stretched = [&](const Vec3& x) -> Vec3 {
    const double over = n.dot(x) - faces.offset_a;
    return x - n * n.dot(x) + scale * over * n;
  };
  const auto support = [&](const Vec3& direction) {
    const double along = n.dot(direction);
    const Vec3 across = direction - along * n;
    // Stretched, B's face leans by about 1.
    const Vec3 across_b = across + along * scale * lean_b;
    Vec3 of_a = a.support(Pose{}, n + kLeanOnFace * across.stableNormalized()),
         of_b = b.support(X_AB, faces.normal_b - kLeanOnFace * across_b.stableNormalized());
    if (along < 0.0) of_a -= kLayerRoom * faces.depth * n;
    if (along < 0.0) of_b += kLayerRoom * faces.depth * n;
    return Corner{stretched(of_a) - stretched(of_b) - apart * scale * n, of_a};
  };
  apart = faces.depth;
  for (int halving = 0; halving < kLayerHalvings; ++halving) {
    apart *= 0.5;
    if (!find_common_point(support, n, point)) continue;
    // Some way off the edges of the faces: the mean of points that were found from other sides.
    const Mat3 basis = basis_with_z(n);
    Vec3 sum = point;
    int count = 1;
    for (const Vec3& first : {Vec3(basis.col(0)), Vec3(basis.col(1))}) {
      Vec3 another;
      if (!find_common_point(support, first, another)) continue;
      sum += another;
      ++count;
    }
    point = sum / count;
    return true;
  }
  return false;
}

}  // namespace volcontact
