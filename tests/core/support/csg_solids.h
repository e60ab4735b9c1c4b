// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "volcontact/shape/csg/csg.h"

namespace volcontact {

inline Csg operator+(const Csg& a, const Csg& b) { return Csg(Csg::Operation::kUnion, a, b); }
inline Csg operator&(const Csg& a, const Csg& b) {
  return Csg(Csg::Operation::kIntersection, a, b);
}
inline Csg operator-(const Csg& a, const Csg& b) { return Csg(Csg::Operation::kDifference, a, b); }

namespace testing {

inline Pose at(double x, double y, double z) { return {Mat3::Identity(), Vec3(x, y, z)}; }
inline Pose turned(const Vec3& axis, double angle, const Vec3& position) {
  return {rotation_about(axis.normalized(), angle), position};
}
inline Csg box(double x, double y, double z, const Pose& X = {}) {
  return Csg(Box({.half_sizes = {x, y, z}}), X);
}
inline Csg tube(double radius, double half_length, const Pose& X = {}) {
  return Csg(Cylinder({.radius = radius, .half_length = half_length}), X);
}
inline Csg cone(double bottom, double top, double half_length, const Pose& X = {}) {
  return Csg(Frustum({.bottom_radius = bottom, .top_radius = top, .half_length = half_length}), X);
}
inline Csg ball(double radius, const Pose& X = {}) { return Csg(Sphere({.radius = radius}), X); }
inline Csg capsule(double radius, double half_length, const Pose& X = {}) {
  return Csg(Capsule({.radius = radius, .half_length = half_length}), X);
}
inline Csg counterbored() { return box(.3, .2, .1) - tube(.05, .5) - tube(.1, .05, at(0, 0, .08)); }

struct NamedSolid {
  std::string name;
  Csg solid;
  int carved_pieces;  ///< 0 where the solid cannot be written so
};

/// Bounded solids of a few tenths of a metre, of all kinds that parts are made of.
inline std::vector<NamedSolid> kinds_of_solids() {
  const Pose tilted = turned({1, 2, 3}, 0.7, {.05, .02, -.03});
  const Pose flat = turned(Vec3::UnitY(), kPi / 2, {0, 0, .1});
  return {
      {"through bore", box(.3, .2, .1) - tube(.05, .5), 1},
      {"tilted bore", box(.3, .2, .1) - tube(.05, .5, tilted), 1},
      {"blind bore", box(.3, .2, .1) - tube(.05, .1, at(.1, 0, .1)), 2},
      {"counterbore", counterbored(), 2},
      {"chamfer", box(.3, .2, .1) - tube(.05, .5) - cone(.05, .07, .01, at(0, 0, .09)), 2},
      {"pipe", tube(.2, .3) - tube(.1, .4), 1},
      {"cup", tube(.2, .3) - cone(.1, .15, .2, at(0, 0, .1)), 2},
      {"pointed cup", tube(.2, .3) - cone(.0, .15, .2, at(0, 0, .1)), 2},
      {"plate with holes",
       box(.3, .2, .05) - tube(.05, .1, at(.15, 0, 0)) - tube(.04, .1, at(-.15, .05, 0)) -
           tube(.04, .03, at(0, 0, .05)),
       2},
      {"boxes apart", box(.1, .1, .1) + box(.1, .1, .1, at(.25, 0, 0)), 2},
      {"boxes that touch", box(.1, .1, .1) + box(.1, .05, .05, at(.2, 0, 0)), 2},
      {"boxes with flush faces", box(.1, .1, .1) + box(.1, .1, .1, at(.15, 0, 0)), 2},
      {"boxes that overlap",
       box(.1, .1, .1) + box(.1, .1, .1, turned({1, 1, 0}, .6, {.12, .05, .02})), 5},
      {"boss on a plate", box(.3, .2, .05) + tube(.05, .1, at(.1, 0, .15)), 2},
      {"boss into a plate", box(.3, .2, .05) + tube(.05, .1, at(.1, 0, .1)), 2},
      {"boss over an edge", box(.3, .2, .05) + tube(.05, .1, at(.3, 0, .1)), 0},
      {"bored boss",
       (box(.3, .2, .05) + tube(.08, .1, at(.1, 0, .1))) - tube(.04, .5, at(.1, 0, 0)), 2},
      {"socket", box(.2, .2, .1) - ball(.15, at(0, 0, .1)), 1},
      {"pocket", box(.2, .2, .1) - box(.1, .1, .05, at(0, 0, .08)), 5},
      {"round slot", box(.3, .2, .1) - capsule(.05, .1, flat), 3},
      {"short rod of a ball", ball(.2) & tube(.15, .15), 0},
      {"bead", ball(.2) - tube(.1, .3), 1},
      {"two balls", ball(.2) + ball(.2, at(.2, .1, 0)), 0},
      {"ring groove", box(.3, .2, .1) - (tube(.1, .05, at(0, 0, .1)) - tube(.05, .2)), 0},
      {"rods in line", tube(.1, .1) + tube(.1, .1, at(0, 0, .2)), 2},
      {"rods that overlap", tube(.1, .1) + tube(.1, .1, at(0, 0, .1)), 2},
      {"cut corner", box(.2, .2, .2) - Csg(HalfSpace(), tilted), 1},
      {"crossing bores",
       box(.2, .2, .2) - tube(.05, .5) -
           tube(.05, .5, turned(Vec3::UnitX(), kPi / 2, Vec3::Zero())),
       1},
      {"bores that meet", (box(.2, .2, .1) - tube(.05, .5)) & (box(.2, .2, .1) - cone(.02, .1, .1)),
       2},
      {"holes of one tool", box(.3, .2, .1) - (tube(.05, .5) + cone(.05, .07, .01, at(0, 0, .09))),
       2},
  };
}

/// Where the line p + t d meets the face F = 0.
inline std::vector<double> crossings(const Quadric& face, const Vec3& p, const Vec3& d) {
  const double a = 0.5 * d.dot(face.hessian * d), b = d.dot(face.linear + face.hessian * p);
  const double c = face(p);
  if (std::abs(a) < 1e-12) return {-c / b};
  const double root = b * b - 4.0 * a * c;
  if (root < 0.0) return {};
  return {(-b + std::sqrt(root)) / (2.0 * a), (-b - std::sqrt(root)) / (2.0 * a)};
}

}  // namespace testing
}  // namespace volcontact
