// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/in_round/points_within.h"

#include <algorithm>

namespace volcontact {
namespace {

using Pieces = std::vector<RoundPieces::Triangle>;

double square_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double square = way.squaredNorm();
  const double t = square > 0.0 ? std::clamp((p - a).dot(way) / square, 0.0, 1.0) : 0.0;
  return (a + t * way - p).squaredNorm();
}

double square_to_edges(const Vec3& p, const Vec3 (&c)[3]) {
  double least = kInfinity;
  for (int i = 0; i < 3; ++i) least = std::min(least, square_to_segment(p, c[i], c[(i + 1) % 3]));
  return least;
}

double square_to_triangle(const Vec3& p, const Vec3 (&c)[3]) {
  const Vec3 n = (c[1] - c[0]).cross(c[2] - c[0]);
  bool over = true;
  for (int i = 0; i < 3; ++i) over &= n.dot((c[(i + 1) % 3] - c[i]).cross(p - c[i])) > 0.0;
  if (!over) return square_to_edges(p, c);
  const double height = n.dot(p - c[0]);
  return height * height / n.squaredNorm();
}

// Keeps the farthest of the points that it is asked about, the first of them where they are equal.
template <typename Square>
class Farthest {
 public:
  Farthest(const Pieces& triangles, Square square) : triangles_(triangles), square_(square) {}

  void look(const Vec3& p) {
    double nearest = kInfinity;
    for (const RoundPieces::Triangle& t : triangles_) {
      nearest = std::min(nearest, square_(p, t.corner));
      if (nearest <= farthest_) return;
    }
    farthest_ = nearest;
    best_ = p;
  }
  const Vec3& best() const { return best_; }

 private:
  const Pieces& triangles_;
  const Square square_;
  Vec3 best_ = Vec3::Zero();
  double farthest_ = -1.0;
};

}  // namespace

Vec3 point_off_edges(const ConvexView& solid, const Pose& X_QB, const Pieces& triangles) {
  Farthest farthest(triangles, square_to_edges);
  farthest.look(Vec3::Zero());
  for (const Vec3& way :
       {Vec3(1.0, 1.0, 1.0), Vec3(1.0, -1.0, -1.0), Vec3(-1.0, 1.0, -1.0), Vec3(-1.0, -1.0, 1.0)}) {
    farthest.look(0.5 * solid.support(X_QB, way));
  }
  return farthest.best();
}

Vec3 point_off_faces(const ConvexView& solid, const Pose& X_QB, const Pieces& triangles) {
  Farthest farthest(triangles, square_to_triangle);
  farthest.look(Vec3::Zero());
  for (int corner = 0; corner < 8; ++corner) {
    farthest.look(0.5 * solid.support(X_QB, corner_signs(corner)));
  }
  for (int side = 0; side < 6; ++side) {
    const Vec3 way = (side & 1 ? 1.0 : -1.0) * Vec3::Unit(side / 2);
    farthest.look(0.6 * solid.support(X_QB, way));
  }
  return farthest.best();
}

}  // namespace volcontact
