// SPDX-License-Identifier: Apache-2.0
#include "core/search/search_solids.h"

#include <algorithm>
#include <cstdio>

namespace volcontact::test {
namespace {

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  double back = 0.0;
  char shorter[40];
  std::snprintf(shorter, sizeof shorter, "%.15g", x);
  std::sscanf(shorter, "%lf", &back);
  return back == x ? shorter : text;
}

std::string numbers(std::initializer_list<double> all) {
  std::string text;
  for (const double x : all) {
    if (!text.empty()) text += ", ";
    text += number(x);
  }
  return text;
}

// name(arguments)
std::string call(const char* name, const std::string& arguments) {
  std::string text = name;
  text += '(';
  text += arguments;
  text += ')';
  return text;
}

std::string triple(const Vec3& v) { return call("", numbers({v.x(), v.y(), v.z()})); }

std::string list(const std::vector<Vec3>& points) {
  std::string text = "[";
  for (const Vec3& p : points) {
    text += triple(p);
    text += ", ";
  }
  text += ']';
  return call("np.array", text);
}

SearchSolid of_mesh(const Soup& soup, ImplicitSolid implicit, double size) {
  std::string faces = "[";
  for (const Triangle& t : soup.triangles) {
    faces +=
        call("", std::to_string(t[0]) + ", " + std::to_string(t[1]) + ", " + std::to_string(t[2]));
    faces += ", ";
  }
  faces += ']';
  std::string text = call("Mesh", list(soup.vertices) + ", " + call("np.array", faces));
  return {mesh_of(soup), std::move(implicit), std::move(text), {}, {}, size};
}

// What two composed solids have, features and all; the texts of both with the sign between them.
SearchSolid joined(const SearchSolid& a, const SearchSolid& b, Csg::Operation operation,
                   const char* sign, ImplicitSolid implicit) {
  SearchSolid solid{Csg(operation, composed(a.shape), composed(b.shape)),
                    std::move(implicit),
                    call("", a.text + ' ' + sign + ' ' + b.text),
                    a.radii,
                    a.heights,
                    std::max(a.size, b.size)};
  solid.radii.insert(solid.radii.end(), b.radii.begin(), b.radii.end());
  solid.heights.insert(solid.heights.end(), b.heights.begin(), b.heights.end());
  if (operation == Csg::Operation::kIntersection) solid.size = std::min(a.size, b.size);
  if (operation == Csg::Operation::kDifference) solid.size = a.size;
  return solid;
}

std::vector<Vec3> prism(double radius, double half_height, int n) {
  std::vector<Vec3> points;
  for (const double z : {-half_height, half_height}) {
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * kPi * i / n;
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  return points;
}

}  // namespace

SearchSolid search_half_space() {
  return {HalfSpace(), ImplicitSolid::half_space(), "HalfSpace()", {0.0}, {0.0}, 1.0};
}
SearchSolid search_sphere(double r) {
  return {Sphere({.radius = r}),
          ImplicitSolid::ellipsoid(Vec3::Constant(r)),
          call("Sphere", number(r)),
          {r},
          {0.0, r},
          r};
}
SearchSolid search_ellipsoid(const Vec3& a) {
  return {Ellipsoid({.semi_axes = a}),
          ImplicitSolid::ellipsoid(a),
          call("Ellipsoid", triple(a)),
          {a.x(), a.y()},
          {0.0, a.z()},
          a.maxCoeff()};
}
SearchSolid search_capsule(double r, double h) {
  return {Capsule({.radius = r, .half_length = h}),
          ImplicitSolid::capsule(r, h),
          call("Capsule", numbers({r, h})),
          {r},
          {h, r + h},
          r + h};
}
SearchSolid search_cylinder(double r, double h) {
  return {Cylinder({.radius = r, .half_length = h}),
          ImplicitSolid::frustum(r, r, h),
          call("Cylinder", numbers({r, h})),
          {r},
          {h},
          std::hypot(r, h)};
}
SearchSolid search_frustum(double bottom, double top, double h) {
  return {Frustum({.bottom_radius = bottom, .top_radius = top, .half_length = h}),
          ImplicitSolid::frustum(bottom, top, h),
          call("Frustum", numbers({bottom, top, h})),
          {bottom, top},
          {h},
          std::hypot(std::max(bottom, top), h)};
}
SearchSolid search_box(const Vec3& half) {
  return {Box({.half_sizes = half}),
          ImplicitSolid::box(half),
          call("Box", triple(half)),
          {half.x(), half.y(), std::hypot(half.x(), half.y())},
          {half.z()},
          half.norm()};
}
SearchSolid search_torus(double major, double minor) {
  return {Torus({.major_radius = major, .minor_radius = minor}),
          ImplicitSolid::torus(major, minor),
          call("Torus", numbers({major, minor})),
          {major - minor, major, major + minor, minor},
          {0.0, minor},
          major + minor};
}
SearchSolid search_polytope(const std::vector<Vec3>& points) {
  ImplicitSolid implicit = ImplicitSolid::polytope(points);
  const double size = implicit.radius;
  return {ConvexPolytope(points),
          std::move(implicit),
          call("ConvexPolytope", list(points)),
          {},
          {},
          size};
}

SearchSolid search_hull_mesh(const std::vector<Vec3>& points) {
  const ConvexPolytope hull(points);
  Soup soup;
  soup.vertices = hull.vertices();
  for (const ConvexPolytope::Face& face : hull.faces()) {
    for (std::size_t i = 2; i < face.loop.size(); ++i) {
      soup.triangles.push_back({face.loop[0], face.loop[i - 1], face.loop[i]});
    }
  }
  ImplicitSolid implicit = ImplicitSolid::polytope(points);
  const double size = implicit.radius;
  return of_mesh(soup, std::move(implicit), size);
}
SearchSolid search_box_mesh(const Vec3& half, int n) {
  SearchSolid solid = of_mesh(box_soup(half, n), ImplicitSolid::box(half), half.norm());
  solid.radii = {half.x(), half.y(), std::hypot(half.x(), half.y())};
  solid.heights = {half.z()};
  return solid;
}
SearchSolid search_ring_mesh(double inner, double outer, double half, int n) {
  const ImplicitSolid body = ImplicitSolid::polytope(prism(outer, half, n));
  SearchSolid solid =
      of_mesh(ring_soup(inner, outer, half, n),
              body - ImplicitSolid::polytope(prism(inner, 1.5 * half, n)), std::hypot(outer, half));
  const double middle = std::cos(kPi / n);
  solid.radii = {inner, outer, inner * middle, outer * middle};
  solid.heights = {half};
  return solid;
}

SearchSolid operator+(const SearchSolid& a, const SearchSolid& b) {
  return joined(a, b, Csg::Operation::kUnion, "+", a.implicit | b.implicit);
}
SearchSolid operator&(const SearchSolid& a, const SearchSolid& b) {
  return joined(a, b, Csg::Operation::kIntersection, "&", a.implicit & b.implicit);
}
SearchSolid operator-(const SearchSolid& a, const SearchSolid& b) {
  return joined(a, b, Csg::Operation::kDifference, "-", a.implicit - b.implicit);
}

SearchSolid posed(const SearchSolid& solid, const Pose& X) {
  SearchSolid result = solid;
  result.shape = composed(solid.shape).posed(X);
  result.implicit = solid.implicit.posed(X);
  result.text += call(".posed", python_pose(X));
  const double z = X.translation.z();
  // What special poses make meet is about the z axis: of a member elsewhere, its place as well.
  for (double& height : result.heights) height += z;
  const double away = std::hypot(X.translation.x(), X.translation.y());
  if (away > 0.0) result.radii.push_back(away);
  result.size = solid.size + X.translation.norm();
  return result;
}

std::string python_pose(const Pose& X) {
  std::string text = "np.array([";
  for (int i = 0; i < 3; ++i) {
    text += '[';
    text += numbers({X.rotation(i, 0), X.rotation(i, 1), X.rotation(i, 2), X.translation[i]});
    text += "], ";
  }
  text += "[0, 0, 0, 1.0]])";
  return text;
}

}  // namespace volcontact::test
