// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/surface_sweep/curve_family.h"

namespace volcontact {

/// Fluxes of 1, x, x x and x x x^T through a part of the surface of an overlap, outward, and its
/// area. Of a closed surface `moment` is V times the identity.
struct SweepFlux {
  Vec3 normal = Vec3::Zero();  ///< int n dS
  Mat3 moment = Mat3::Zero();  ///< int x n^T dS
  Vec3 first = Vec3::Zero();   ///< 1/4 int x (x . n) dS
  Mat3 second = Mat3::Zero();  ///< 1/5 int x x^T (x . n) dS
  double area = 0.0;

  void add(const Vec3& x, const Vec3& n) {
    const double out = x.dot(n);
    normal += n;
    moment += outer(x, n);
    first += 0.25 * out * x;
    second += 0.2 * out * outer(x, x);
    area += n.norm();
  }
  void operator+=(const SweepFlux& other) {
    normal += other.normal;
    moment += other.moment;
    first += other.first;
    second += other.second;
    area += other.area;
  }
};

/// Stretches of neighbouring curves of a face, between the same two faces all along.
struct SweepStrip {
  Owner owner = Owner::kA;
  SweepFlux flux;
  double error = 0.0;  ///< estimate, of a third of the flux of x
  int site = -1;
  SweepEnd low, high;    ///< on the curve in the middle
  Vec3 at_low, at_high;  ///< where those are
};

/// Curves of a face without a change: `count` strips, from `first` on.
struct SweepStretch {
  double low, high;
  int first, count;
};

/// A place of the surface for columns, and n dS that it stands for.
struct SweepPlace {
  Vec3 x, n;
  int strip;
};

/// Where a curve ends.
struct SweepTip {
  Vec3 x;
  int strip;
};

struct SweepSurface {
  std::vector<SweepStrip> strips;
  std::vector<SweepPlace> places;
  std::vector<SweepTip> tips;

  void clear();
  /// Adds a part of the surface, its strips numbered on.
  void append(const SweepSurface& part);
};

/// The surface of an overlap in one face.
struct SweepPatch {
  std::vector<SweepStretch> stretches;  ///< in order; their strips are counted within the patch
  std::vector<double> hints;            ///< curves to look at besides
  SweepSurface surface;
  int base = 0;        ///< number of its first strip in the whole surface
  bool stale = true;   ///< to be swept (again)
  bool swept = false;  ///< for some target, so that what follows is known; it has all hints
  std::vector<double> events;
};

/// Memory of the sweep over a face.
struct SweepPatchScratch {
  struct Sample {
    double u;
    SweepSpans spans;
  };
  std::vector<Sample> samples;
  std::vector<double> events;
  FaceCurveScratch curve;
};

/// Sweeps over the curves of a face, which is its own twin: finds where the overlap has surface
/// there, and integrates. Events of an earlier sweep of the patch serve again unless a hint has
/// come since. False when it gives up. docs/theory.md, "Surface sweep".
bool sweep_face(const SweepSolids& solids, int face, const CurveFamily& family, double target,
                SweepPatchScratch& scratch, SweepPatch& patch);

}  // namespace volcontact
