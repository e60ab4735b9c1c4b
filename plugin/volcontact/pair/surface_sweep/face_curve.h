// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/surface_sweep/sweep_solid.h"

namespace volcontact {

/// A line p + t u, or a circle p + cos t u + sin t v with 0 <= t < 2 pi.
struct FaceCurve {
  bool circle = false;
  Vec3 p, u, v;

  Vec3 at(double t) const {
    if (circle) return p + std::cos(t) * u + std::sin(t) * v;
    return p + t * u;
  }
};

/// Where a curve passes through a face of a part: into the part, or out of it.
struct SweepEnd {
  double t = 0.0;
  int face = -1;  ///< none where a circle begins or ends, at 0 or 2 pi
  bool leaves = false;
  int also = -1;   ///< another face in the same place
  int smooth = 0;  ///< SweepFace::smooth of the face

  bool same_as(const SweepEnd& other) const {
    return smooth == other.smooth && (smooth < 0 || leaves == other.leaves);
  }
};

/// Stretches of a curve, in order. Of a circle none goes on beyond 2 pi.
struct SweepSpans {
  struct Span {
    SweepEnd low, high;
    Owner owner;  ///< whose surface the curve lies in
    int side;     ///< 1: the solid is where the normal of the face does not look
    bool same_as(const Span& other) const {
      return low.same_as(other.low) && high.same_as(other.high) && owner == other.owner &&
             side == other.side;
    }
  };
  static constexpr int kMost = 12;
  int count = 0;
  bool overflow = false;
  Span span[kMost];

  /// A stretch of a circle that begins at 0 is the rest of one that ends at 2 pi.
  bool is_rest() const {
    return count > 1 && span[0].low.face < 0 && span[count - 1].high.face < 0;
  }
  bool same_as(const SweepSpans& other) const {
    if (count != other.count) return false;
    for (int i = 0; i < count; ++i) {
      if (!span[i].same_as(other.span[i])) return false;
    }
    return true;
  }
};

/// Memory of the search.
struct FaceCurveScratch {
  struct Toggle {
    double t;
    int part, face;
    bool leaves;
  };
  std::vector<Toggle> toggles;
  std::vector<Toggle> crossings;  ///< of the faces of one part; `leaves` the face
};

/// Stretches of a curve that lies in a face (`face`, which is its own twin) where that face is
/// surface of the overlap; with face -1, of a line anywhere, where it lies in the overlap.
void find_spans(const SweepSolids& solids, const FaceCurve& curve, int face,
                FaceCurveScratch& scratch, SweepSpans& spans);

/// The place of an end on a curve that has it or had it a moment ago; NaN where there is none or
/// where it would have to be searched for.
double end_on(const SweepFace& face, const FaceCurve& curve, bool leaves);

/// Positive where a curve passes through a round face, or a circle through a plane, smooth as far
/// as it touches; NaN as above.
double reach_of(const SweepFace& face, const FaceCurve& curve);

}  // namespace volcontact
