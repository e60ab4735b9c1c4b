// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/bore/bore_outline.h"

#include <algorithm>

#include "volcontact/pair/sections/even_turn.h"
#include "volcontact/pair/sections/rim_shape.h"

namespace volcontact {
namespace {

constexpr int kMaxRoundings = 24;  // of the frame
constexpr double kRoundRim =
    3.0;                        // longest by shortest way to the outline; then it is round enough
constexpr double kSpike = 6.0;  // longest by shortest of all ways: a spike between the first ones
constexpr double kLeastCosine = 0.5;    // of the half of a turn between directions
constexpr double kStraight = 1e-6;      // sine of a turn below which the outline has no corner
constexpr int kNarrowings = 3;          // of a place where the outline comes near the wall
constexpr int kMostNarrowings = 16;     // of one at a corner that may reach through it
constexpr int kEndNarrowings = 2;       // of a place where it crosses the wall
constexpr int kMostEndNarrowings = 16;  // of one at the end of a narrow lobe
constexpr double kEndShare = 0.1;       // of half a lobe: as closely as this its ends are searched

}  // namespace

BodyInBore::BodyInBore(const ConvexView& body, const Pose& X, Owner owner, const Bore& bore,
                       FaceSet& faces) {
  if (bore.is_cone()) return;
  faces.clear();
  FaceWriter writer(faces, X, owner);
  body.write_faces(writer);
  const auto add = [&](const Vec3& center, double radius) {
    middle_[count_] = bore.from_axis(center) / bore.radius;
    radius_[count_++] = radius / bore.radius;
  };
  if (faces.rims.size() == 2) {  // a cylinder, frustum or capsule
    for (const Rim& rim : faces.rims) add(rim.center, rim.radius_u.norm());
  } else if (faces.planes.empty() && faces.rounds.size() == 1) {  // a ball or an ellipsoid
    const RoundFace& round = faces.rounds[0];
    add(round.center, 1.0 / row_lengths(round.map).minCoeff());
  }
}

double BodyInBore::reach() const {
  double most = count_ > 0 ? 0.0 : kInfinity;
  for (int i = 0; i < count_; ++i) most = std::max(most, middle_[i].norm() + radius_[i]);
  return most;
}

// A unit vector between others is their sum with parts of 1 / cosine in all, at most, where that is
// the cosine of half of the widest turn between them.
double BodyInBore::reach(const Vec3& one, const Vec3& two, const Vec3& three) const {
  const Vec3 e[] = {one.normalized(), two.normalized(), three.normalized()};
  const double least = std::min({e[0].dot(e[1]), e[1].dot(e[2]), e[2].dot(e[0])});
  const double cosine = std::sqrt(std::max(0.0, 0.5 * (1.0 + least)));
  if (!(cosine > kLeastCosine)) return kInfinity;
  double most = count_ > 0 ? 0.0 : kInfinity;
  for (int i = 0; i < count_; ++i) {
    const double along =
        std::max({0.0, middle_[i].dot(e[0]), middle_[i].dot(e[1]), middle_[i].dot(e[2])});
    most = std::max(most, along / cosine + radius_[i]);
  }
  return most;
}

// A set of sections along the bore's axis, or from the apex, through the middle of the overlap, in
// which its outline is about round.
void BoreOutline::choose_frame() {
  if (bore_.is_cone()) {
    const Vec3 way = window_.center - bore_.center;
    const double length = way.norm();
    frame_ = round_frame(bore_.center, window_.spread, way / length);
    frame_.t *= length;
    frame_.central = true;
  } else {
    frame_ = round_frame(window_.center, window_.spread, bore_.axis);
  }
}

void BoreOutline::set_frame() {
  s_.faces.active.has_bore = false;
  s_.sections.set(s_.faces.active, s_.faces.idle, frame_);
}

BoreOutline::Place BoreOutline::place(double angle, double x, double y, double height) const {
  const Vec3 point = frame_.place(x, y, height);
  return {angle, bore_.radii(point), point};
}

// Eight places of the outline at these angles.
void BoreOutline::places_at(const double* angles, Place* places) {
  double u[kLanes], v[kLanes], rho[kLanes], height[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    u[i] = std::cos(angles[i]);
    v[i] = std::sin(angles[i]);
  }
  s_.sections.ends(s_.path, u, v, rho, height);
  for (int i = 0; i < kLanes; ++i) {
    places[i] = place(angles[i], rho[i] * u[i], rho[i] * v[i], height[i]);
  }
}

// Fills `places_` in the present frame. False when the outline is not round in it; then the frame
// is a rounder one.
bool BoreOutline::place_all_round() {
  constexpr int kStep = kEvenTurn / kLanes;
  double shortest = kInfinity, longest = 0.0;
  RimShape farthest;
  for (int k = 0; k < kStep; ++k) {
    RimShape rim;
    even_directions(kEvenTurn, k, rim.u, rim.v);
    s_.sections.ends(s_.path, rim.u, rim.v, rim.rho, rim.height);
    const double near = rim.shortest(), far = rim.longest();
    if (k == 0 && far > kRoundRim * near) {
      if (!rim.round_off(frame_)) rim.go_inwards(frame_);
      return false;
    }
    if (far > longest) farthest = rim;
    shortest = std::min(shortest, near);
    longest = std::max(longest, far);
    for (int i = 0; i < kLanes; ++i) {
      const int at = k + kStep * i;
      places_[at] = place(2.0 * kPi * at / kEvenTurn, rim.rho[i] * rim.u[i], rim.rho[i] * rim.v[i],
                          rim.height[i]);
    }
  }
  if (longest < kSpike * shortest) return true;
  farthest.go_inwards(frame_);
  return false;
}

bool BoreOutline::trace() {
  choose_frame();
  set_frame();
  places_.resize(kEvenTurn);
  // The window knows a thin overlap's shape only roughly.
  for (int turns = 0; !place_all_round(); ++turns) {
    if (turns == kMaxRoundings) return false;
    set_frame();
  }
  // Places that come nearest to the wall may hide a lobe between them, or a dip.
  const int n = kEvenTurn;
  for (int k = 0; k < n; ++k) {
    const Place p = places_[k], before = places_[(k + n - 1) % n], after = places_[(k + 1) % n];
    const double side = p.rho > 1.0 ? -1.0 : 1.0;
    const double fall = side * p.rho - side * (side > 0.0 ? std::min(before.rho, after.rho)
                                                          : std::max(before.rho, after.rho));
    if (side * before.rho > side * p.rho || side * after.rho > side * p.rho) continue;
    if (side * (p.rho - 1.0) + 2.0 * fall < 0.0) continue;
    // To both sides: the end of a face has two corners.
    for (const double way : {-1.0, 1.0}) {
      const double end = p.angle + way * 2.0 * kPi / n;
      const Place top = summit(std::min(p.angle, end), std::max(p.angle, end), side);
      if (side * (top.rho - 1.0) > 0.0) places_.push_back(top);
    }
  }
  look_behind_corners();
  std::sort(places_.begin(), places_.end(),
            [](const Place& p, const Place& q) { return p.angle < q.angle; });
  return true;
}

// Between two places within the wall a part of the outline may stick out of it. As the outline is
// convex, it lies in the triangle that the chords before and after them make with their own.
void BoreOutline::look_behind_corners() {
  const std::size_t n = kEvenTurn;
  const auto turn = [&](const Vec3& from, const Vec3& to) {
    return from.cross(to).dot(bore_.axis);
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Place &here = places_[k], &next = places_[(k + 1) % n];
    if (here.rho > 1.0 || next.rho > 1.0) continue;
    const Vec3 from = bore_.seen(here.point), way = bore_.seen(next.point) - from;
    const Vec3 before = from - bore_.seen(places_[(k + n - 1) % n].point);
    const Vec3 after = bore_.seen(places_[(k + 2) % n].point) - from - way;
    const double length = kStraight * way.norm();
    if (std::abs(turn(before, way)) <= length * before.norm() ||
        std::abs(turn(way, after)) <= length * after.norm()) {
      continue;  // along one of the chords
    }
    const double both = turn(before, after), ahead = turn(way, after) / both;
    const Vec3 tip = from + ahead * before;
    if (ahead > 0.0 && (tip.norm() <= 1.0 || body_.reach(from, tip, from + way) <= 1.0)) continue;
    const double angle = here.angle;
    const Place top = summit(angle, angle + 2.0 * kPi / kEvenTurn, 1.0);
    if (top.rho > 1.0) places_.push_back(top);
  }
}

// Where the outline is farthest from the axis between two angles; nearest to it with a negative
// `side`.
BoreOutline::Place BoreOutline::summit(double from, double to, double side) {
  Place places[kLanes];
  Place top;
  for (int step = 1; step <= kMostNarrowings; ++step) {
    double angles[kLanes];
    for (int i = 0; i < kLanes; ++i) angles[i] = from + (to - from) * (i + 1) / (kLanes + 1);
    places_at(angles, places);
    const int best = static_cast<int>(std::max_element(places, places + kLanes,
                                                       [&](const Place& p, const Place& q) {
                                                         return side * p.rho < side * q.rho;
                                                       }) -
                                      places);
    top = places[best];
    const double width = (to - from) / (kLanes + 1);
    if (step >= kNarrowings) {
      // A corner beside the best place rises no more than the outline does up to it, or up to the
      // place before.
      const auto rho = [&](int i) { return side * places[std::clamp(i, 0, kLanes - 1)].rho; };
      const double here = rho(best), before = rho(best - 1), after = rho(best + 1);
      double highest = 2.0 * here - std::min(before, after);
      if (best == 0) highest = std::max(highest, 2.0 * rho(1) - rho(2));
      if (best + 1 == kLanes) highest = std::max(highest, 2.0 * before - rho(best - 2));
      if (best > 0 && best + 1 < kLanes) {
        // The summit of the parabola through three places.
        const double bend = before - 2.0 * here + after;
        if (bend < 0.0) {
          std::fill_n(angles, kLanes, top.angle + 0.5 * width * (before - after) / bend);
          places_at(angles, places);
          if (side * places[0].rho > here) top = places[0];
        }
      }
      if (side * (top.rho - 1.0) > 0.0 || highest < side) break;
    }
    from = top.angle - width;
    to = top.angle + width;
  }
  top.angle = std::fmod(top.angle + 2.0 * kPi, 2.0 * kPi);
  return top;
}

// Where the outline crosses the wall.
void BoreOutline::crossings(const Place& top, Place (&inner)[2], Place (&outer)[2],
                            Place (&found)[2]) {
  set_frame();
  constexpr int kShare = kLanes / 2;
  double angles[kLanes];
  Place places[kLanes];
  for (int side : {0, 1}) {
    outer[side].angle = inner[side].angle + wrapped(outer[side].angle - inner[side].angle);
  }
  // Whether the ends are known well enough for chords. The outer places of a lobe that one place
  // stands for are its top at first.
  const auto close = [&] {
    for (int side : {0, 1}) {
      const double half = std::abs(wrapped(outer[side].angle - top.angle));
      if (std::abs(outer[side].angle - inner[side].angle) > kEndShare * half) return false;
    }
    return true;
  };
  for (int step = 0; step < kMostEndNarrowings; ++step) {
    if (step >= kEndNarrowings && close()) break;
    for (int i = 0; i < kLanes; ++i) {
      const int side = i / kShare;
      const double part = (i % kShare + 1.0) / (kShare + 1.0);
      angles[i] = (1.0 - part) * inner[side].angle + part * outer[side].angle;
    }
    places_at(angles, places);
    for (int i = 0; i < kLanes; ++i) {
      const int side = i / kShare;
      if (places[i].rho <= 1.0) {
        inner[side] = places[i];
      } else {
        outer[side] = places[i];
        i = kShare * (side + 1) - 1;  // on to the other side
      }
    }
  }
  // The last step goes to where the chord crosses.
  for (int i = 0; i < kLanes; ++i) {
    const Place &from = inner[i / kShare], &to = outer[i / kShare];
    const double part = std::clamp((1.0 - from.rho) / (to.rho - from.rho), 0.0, 1.0);
    angles[i] = from.angle + (to.angle - from.angle) * part;
  }
  places_at(angles, places);
  found[0] = places[0];
  found[1] = places[kShare];
}

void BoreOutline::between(const Place (&from)[2], const Place (&to)[2], Place (&places)[kLanes]) {
  constexpr double kParts[] = {0.01, 0.1, 0.4, 0.7};
  double angles[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const int side = i / (kLanes / 2);
    const double way = wrapped(to[side].angle - from[side].angle);
    angles[i] = from[side].angle + kParts[i % (kLanes / 2)] * way;
  }
  places_at(angles, places);
}

}  // namespace volcontact
