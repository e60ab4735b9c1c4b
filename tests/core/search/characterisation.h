// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/search/contact_poses.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test {

/// Worst and median of an error; no number of it was measured where `count` is 0.
struct Spread {
  int count = 0;
  double median = 0.0, worst = 0.0;
};
Spread spread_of(std::vector<double> values);

/// How one engine did on one ordered pair of solids. Lengths are relative to the radius of gyration
/// of the overlap, areas to A's area in it.
struct Characterisation {
  const Example* a = nullptr;
  const Example* b = nullptr;
  Engine engine = Engine::kAuto;
  int poses = 0;      ///< with an overlap that the reference could integrate
  int handed_on = 0;  ///< further poses that the engine left to another
  Spread volume, centroid, inertia;
  Spread area_vector, area_moment;  ///< of poses without shared faces; see Reference
  Spread gradient, turn;         ///< of the area vector and moment against finite differences of V
  std::optional<double> noise;   ///< rms error of the increments of V along a motion, of their rms
  double volume_beyond = 0.0;    ///< worst error of V less the doubt about the reference
  int bounds_held = 0;           ///< poses where |error of V| <= volume_error
  int missed = 0;                ///< poses with an overlap that the engine answered with V = 0
  double reference_error = 0.0;  ///< worst of the reference's V, from its three directions
  double microseconds = 0.0;     ///< median time of a warm call
};

struct Effort {
  int poses = 6;                   ///< a third each: random, shallow, aligned
  int gradient_poses = 2;          ///< none of the octree: it is smooth to its tolerance only
  int motion_steps = 8;            ///< of the motion for the noise; 0: none
  int octree_poses = 2;            ///< of the poses, those that the octree gets too
  int slow_octree_poses = 1;       ///< the same where it has cones, a torus, a mesh; no motion
  double octree_tolerance = 1e-2;  ///< relative error asked of the octree
  std::span<const Engine> engines = kEngines;  ///< that are measured
};

/// Every engine that serves the pair, both orders.
std::vector<Characterisation> characterise(const Example& a, const Example& b,
                                           const Effort& effort);

}  // namespace volcontact::test
