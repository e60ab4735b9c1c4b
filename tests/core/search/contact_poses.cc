// SPDX-License-Identifier: Apache-2.0
#include "core/search/contact_poses.h"

#include <algorithm>

#include "core/support/meshes.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test {
namespace {

Example example(const Shape& shape, const char* name, const ReferenceSolid& reference) {
  Example e{name, shape, reference, bounds_of(shape), 0.0, own_metrics_of(shape).volume};
  if (!e.bounds.bounded()) e.bounds = {Vec3(-0.4, -0.4, -0.6), Vec3(0.4, 0.4, 0.0)};
  e.size = e.bounds.half_sizes().norm();
  e.reference.number_faces(0);
  return e;
}

Example example(const Shape& shape, const char* name = nullptr) {
  return example(shape, name ? name : name_of(shape), reference_solid(shape));
}

ConvexPolytope gem() {
  Random random(3);
  std::vector<Vec3> points;
  for (int i = 0; i < 18; ++i) points.push_back(0.4 * random.direction());
  return ConvexPolytope(points);
}

Csg placed(const SimpleShape& shape, double height = 0.0) {
  return Csg(shape, Pose{Mat3::Identity(), Vec3(0.0, 0.0, height)});
}
Csg without(const Csg& a, const Csg& b) { return Csg(Csg::Operation::kDifference, a, b); }

Csg bored_block() {
  return without(placed(Box({.half_sizes = Vec3(0.4, 0.4, 0.25)})),
                 placed(Cylinder({.radius = 0.2, .half_length = 0.5})));
}
// A narrow bore below a wide one.
Csg counterbored() {
  const Csg block = placed(Box({.half_sizes = Vec3(0.4, 0.4, 0.25)}));
  return without(without(block, placed(Cylinder({.radius = 0.15, .half_length = 0.5}))),
                 placed(Cylinder({.radius = 0.25, .half_length = 0.2}), 0.3));
}
// The mouth of the bore widens by 0.08 m over the last 0.1 m.
Csg chamfered_hole() {
  const Frustum mouth({.bottom_radius = 0.2, .top_radius = 0.28, .half_length = 0.05});
  return without(bored_block(), placed(mouth, 0.2));
}
Csg hollow_cylinder() {
  return without(placed(Cylinder({.radius = 0.35, .half_length = 0.3})),
                 placed(Cylinder({.radius = 0.22, .half_length = 0.5})));
}
// A cone with a conical hollow that leaves a floor.
Csg cup() {
  return without(
      placed(Frustum({.bottom_radius = 0.2, .top_radius = 0.35, .half_length = 0.3})),
      placed(Frustum({.bottom_radius = 0.12, .top_radius = 0.3, .half_length = 0.25}), 0.1));
}

// A block of 768 triangles. Those that are not convex are compared with manifold3d and CGAL.
Example block() {
  const Vec3 half(0.35, 0.3, 0.25);
  return example(mesh_of(box_soup(half, 8)), "mesh", reference_solid(Box({.half_sizes = half})));
}

struct SurfacePoint {
  Vec3 point, normal, inside;
};

// Where a random line enters the solid, and a point of the line within it.
SurfacePoint surface_point(const Example& e, Random& random) {
  for (;;) {
    const Mat3 r = random.rotation();
    const Vec3 through = e.bounds.center() +
                         Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
                             .cwiseProduct(e.bounds.half_sizes());
    const Pose X_LE{r.transpose(), -(r.transpose() * through)};
    ReferenceSolid solid = e.reference.posed(X_LE);
    const ReferenceSpans spans = solid.column(0.0, 0.0);
    if (spans.size() == 0) continue;
    ReferenceSpan span = spans[static_cast<int>(random.uniform(0.0, spans.size()))];
    if (!std::isfinite(span.enter) && !std::isfinite(span.leave)) continue;
    if (!std::isfinite(span.leave)) span.leave = span.enter + e.size;
    const bool ends = !std::isfinite(span.enter);
    if (ends) span.enter = span.leave - e.size;
    const double t = ends ? span.leave : span.enter;
    const int face = ends ? span.leave_face : span.enter_face;
    const double depth = random.uniform(0.1, 0.9);
    const Vec3 inside(0.0, 0.0, span.enter + depth * (span.leave - span.enter));
    return {through + r * Vec3(0, 0, t), r * solid.normal(face, Vec3(0, 0, t)),
            through + r * inside};
  }
}

}  // namespace

bool is_pair(const Example& a, const Example& b) {
  const auto mesh = [](const Example& e) { return std::holds_alternative<Mesh>(e.shape); };
  if (std::isinf(a.own_volume) && std::isinf(b.own_volume)) return false;
  return !((mesh(a) || mesh(b)) && engine_for(a.shape, b.shape) == Engine::kOctree);
}

namespace {

double range_of(const Example& a, const Example& b) { return 2.0 * std::min(a.size, b.size); }

}  // namespace

const std::vector<Example>& examples() {
  static const std::vector<Example> all = {
      example(HalfSpace()),
      example(Sphere({.radius = 0.35})),
      example(Ellipsoid({.semi_axes = Vec3(0.5, 0.35, 0.2)})),
      example(Capsule({.radius = 0.2, .half_length = 0.3})),
      example(Cylinder({.radius = 0.3, .half_length = 0.25})),
      example(Frustum({.bottom_radius = 0.35, .top_radius = 0.15, .half_length = 0.3})),
      example(Box({.half_sizes = Vec3(0.4, 0.3, 0.2)})),
      example(Torus({.major_radius = 0.35, .minor_radius = 0.12})),
      example(gem()),
      example(bored_block(), "bored_block"),
      example(counterbored(), "counterbored"),
      example(chamfered_hole(), "chamfered_hole"),
      example(hollow_cylinder(), "hollow_cylinder"),
      example(cup(), "cup"),
      block(),
  };
  return all;
}

ContactPose random_overlap(const Example& a, const Example& b, Random& random) {
  const Vec3 in_a = surface_point(a, random).inside, in_b = surface_point(b, random).inside;
  const Mat3 r = random.rotation();
  return {{r, in_a - r * in_b}, {{random.rotation(), in_a}, range_of(a, b)}};
}

ContactPose shallow_overlap(const Example& a, const Example& b, double depth, double tilt,
                            Random& random) {
  const SurfacePoint on_a = surface_point(a, random), on_b = surface_point(b, random);
  const Mat3 spin = turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi));
  const Mat3 lean = tilt > 0.0 ? turn(random.direction(), tilt) : Mat3(Mat3::Identity());
  const Mat3 r = basis_with_z(-on_a.normal) * lean * spin * basis_with_z(on_b.normal).transpose();
  const Vec3 low = on_a.point - depth * on_a.normal;
  const Mat3 look = basis_with_z(on_a.normal) * turn(Vec3::UnitZ(), random.uniform(0.0, kPi));
  return {{r, low - r * on_b.point}, {{look, 0.5 * (low + on_a.point)}, range_of(a, b)}};
}

ContactPose aligned_overlap(const Example& a, const Example& b, Random& random) {
  const auto grid = [&random] { return std::floor(random.uniform(-1.0, 2.0)); };
  const auto place = [&](const Example& e) {
    const Vec3 where(grid(), grid(), grid());
    return Vec3(e.bounds.center() + where.cwiseProduct(e.bounds.half_sizes()));
  };
  const Vec3 on_a = place(a), on_b = place(b);
  Mat3 r = Mat3::Zero();  // one of the 24 rotations that map axes to axes
  const int first = static_cast<int>(random.uniform(0.0, 3.0));
  const int second = (first + (random.uniform() < 0.5 ? 1 : 2)) % 3;
  r(first, 0) = random.uniform() < 0.5 ? 1.0 : -1.0;
  r(second, 1) = random.uniform() < 0.5 ? 1.0 : -1.0;
  r.col(2) = r.col(0).cross(r.col(1));
  const Vec3 p = on_a - r * on_b;
  // The middle of the overlap of the bounds.
  const Vec3 center_b = r * b.bounds.center() + p, half_b = (r * b.bounds.half_sizes()).cwiseAbs();
  const Vec3 low = a.bounds.min.cwiseMax(center_b - half_b);
  const Vec3 high = a.bounds.max.cwiseMin(center_b + half_b);
  return {{r, p}, {{random.rotation(), 0.5 * (low + high)}, range_of(a, b)}};
}

}  // namespace volcontact::test
