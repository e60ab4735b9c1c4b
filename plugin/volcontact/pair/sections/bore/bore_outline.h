// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "volcontact/pair/sections/convex_sections.h"

namespace volcontact {

/// The same angle from -pi to pi.
inline double wrapped(double angle) {
  return angle - 2.0 * kPi * std::floor(angle / (2.0 * kPi) + 0.5);
}

/// The body in a bore that is a tube, as discs or balls that it lies within or between. Bounds how
/// far it reaches from the axis; of other bodies, and in cones, it knows nothing.
class BodyInBore {
 public:
  /// `faces` is memory to be used.
  BodyInBore(const ConvexView& body, const Pose& X, Owner owner, const Bore& bore, FaceSet& faces);

  /// How far it reaches, at most, in radii of the bore.
  double reach() const;
  /// The same in all directions between some, which are not opposite and not 0.
  double reach(const Vec3& one, const Vec3& two, const Vec3& three) const;

 private:
  int count_ = 0;
  Vec3 middle_[2];    // from the axis, in its radii
  double radius_[2];  // also
};

/// The outline of an overlap seen along the axis of a bore, or from the apex of a cone: a convex
/// curve, and where it lies outside of the wall.
class BoreOutline {
 public:
  struct Place {
    double angle;  ///< about the middle of the overlap [rad]
    double rho;    ///< from the axis of the bore, in its radii there
    Vec3 point;
  };

  /// `places` is memory to be used.
  BoreOutline(const Bore& bore, const BodyInBore& body, const LinesWindow& window,
              LinesScratch& lines, std::vector<Place>& places)
      : bore_(bore), body_(body), window_(window), s_(lines), places_(places) {}

  /// Places all round, in the order of their angle. One lies on every part outside of the wall, and
  /// on every part inside, however small. False where the outline is round from nowhere:
  /// places all round would stand at its ends.
  bool trace();
  const std::vector<Place>& places() const { return places_; }

  /// Where the outline crosses the wall on both sides of the `top` of a lobe, between two pairs of
  /// an inner and an outer place.
  void crossings(const Place& top, Place (&inner)[2], Place (&outer)[2], Place (&found)[2]);

  /// Places of the outline on the way from two of them to two others, four each. After crossings().
  void between(const Place (&from)[2], const Place (&to)[2], Place (&places)[kLanes]);

 private:
  void choose_frame();
  bool place_all_round();
  void set_frame();
  void places_at(const double* angles, Place* places);
  Place place(double angle, double x, double y, double height) const;
  void look_behind_corners();
  Place summit(double from, double to, double side);

  const Bore& bore_;
  const BodyInBore& body_;
  const LinesWindow& window_;
  LinesScratch& s_;
  std::vector<Place>& places_;
  SectionFrame frame_;
};

}  // namespace volcontact
