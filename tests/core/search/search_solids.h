// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/reference/implicit_solid.h"
#include "core/support/meshes.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::test {

/// A solid of the random search: for the engines, for the judge, and as a Python expression.
struct SearchSolid {
  Shape shape;
  ImplicitSolid implicit;
  std::string text;
  std::vector<double> radii;    ///< lengths across its z axis that special poses make meet [m]
  std::vector<double> heights;  ///< places on its z axis, likewise [m]
  double size = 0.0;            ///< about half its diameter [m]
};

SearchSolid search_half_space();
SearchSolid search_sphere(double radius);
SearchSolid search_ellipsoid(const Vec3& semi_axes);
SearchSolid search_capsule(double radius, double half_length);
SearchSolid search_cylinder(double radius, double half_length);
SearchSolid search_frustum(double bottom_radius, double top_radius, double half_length);
SearchSolid search_box(const Vec3& half_sizes);
SearchSolid search_torus(double major_radius, double minor_radius);
SearchSolid search_polytope(const std::vector<Vec3>& points);

/// The hull of points as a mesh; a box with n x n squares on a face; a ring of n sides.
SearchSolid search_hull_mesh(const std::vector<Vec3>& points);
SearchSolid search_box_mesh(const Vec3& half_sizes, int n);
SearchSolid search_ring_mesh(double inner, double outer, double half_height, int n);

SearchSolid operator+(const SearchSolid& a, const SearchSolid& b);
SearchSolid operator&(const SearchSolid& a, const SearchSolid& b);
SearchSolid operator-(const SearchSolid& a, const SearchSolid& b);
/// As a member of a composed solid.
SearchSolid posed(const SearchSolid& solid, const Pose& X);

/// The pose as a Python expression.
std::string python_pose(const Pose& X);

}  // namespace volcontact::test
