// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/simd.h"
#include "volcontact/pair/convex/face_set.h"
#include "volcontact/pair/quadrature/outer_rule.h"

namespace volcontact {

/// Axes of a set of sections in A's frame: columns run along the unit vector `t`; a half-plane of
/// the sections is spanned by t and u cos + v sin, from the axis through `center` outwards. u and v
/// are normal to t, of any length and angle. A place is x = center + rho (u cos + v sin) + height
/// t.
///
/// In central sections the columns run through `center` instead, in the half-space ahead of it, and
/// t has any length: a place is x = center + (rho (u cos + v sin) + t) / height. This projective
/// map makes lines of lines and arcs of arcs, so that a half-plane is cut in the same way.
struct SectionFrame {
  Vec3 center;
  Vec3 u, v, t;
  bool central = false;

  double area_scale() const { return u.cross(v).dot(t); }
  Vec3 place(double rho_cos, double rho_sin, double height) const {
    const Vec3 side = rho_cos * u + rho_sin * v;
    if (central) return center + (side + t) / height;
    return center + side + height * t;
  }
};

/// The frame about `center` with columns along the unit vector t, in which an ellipsoid that
/// `spread` makes of the unit ball looks round along the columns.
SectionFrame round_frame(const Vec3& center, const Mat3& spread, const Vec3& t);

/// A plane face in a set of sections: n_t height + rho (n_u cos + n_v sin) <= gap, with gap >= 0.
struct SectionPlane {
  double n_u, n_v, n_t, gap;
  int face;  ///< in FaceSet::planes
};

/// A round face in a set of sections: the height on it is mid -+ root, where mid = mid + rho (mid_u
/// cos + mid_v sin) and root^2 = reach - sum_i sign_i x_i^2, x_i = x_i + rho (x_u_i cos + x_v_i
/// sin).
struct SectionRound {
  static constexpr int kMaxSquares = 6;
  double mid, mid_u, mid_v;
  int squares;
  double x[kMaxSquares], x_u[kMaxSquares], x_v[kMaxSquares], sign[kMaxSquares];
  double reach;
  // Half the gradient at the place rho (u cos + v sin) + height t from the center, and 1 / |its
  // component along the column * root|.
  double g[3], g_u[3], g_v[3], g_t[3];
  double weight;
  bool wall;  ///< parallel to the columns: no root bounds them in reach
  bool cone;
  int lower, upper;  ///< which root bounds the solid below and above: -1, +1, or 0 for neither
  int owner;
  CapsulePart part;
};

/// Ends of a capsule's tube in a set of sections: |along| <= half_length + half_slope height is the
/// tube.
struct SectionSeam {
  bool present = false;
  double along, along_u, along_v, along_t;
  double half_length, half_slope;
};

/// Faces of both solids in a set of sections, in the order of use: group g of planes is [first[g],
/// first[g + 1]). Plain data, as is all that the kernels touch: a kernel must not make an inline
/// function of a class for its own machine that the linker might then take for every machine.
struct SectionFaces {
  enum Group { kLowerA, kUpperA, kLowerB, kUpperB, kWall, kIdleLowerA, kIdleUpperB, kGroups };
  static constexpr int kMaxRounds = 6;  ///< a capsule has three

  const SectionPlane* planes = nullptr;
  int first[kGroups + 1] = {};
  int active_planes = 0;  ///< those before the idle ones
  SectionRound rounds[kMaxRounds];
  int round_count = 0;
  SectionSeam seams[2];
  bool central = false;         ///< the frame is
  bool two_round = false;       ///< both solids have round faces
  double rounding = 0.0;        ///< of a height on a round face
  double plane_rounding = 0.0;  ///< of a height on a plane face
  double start = 0.0;           ///< rho of the wall of a bore about the axis; 0 without
  double area_scale = 0.0;      ///< of the frame
  bool fine = false;            ///< eight nodes on each piece of a section, not five
  int knot_parts = 3;           ///< of a section, each with one knot of two round faces
};

/// Sums over the columns of a set of sections, in coordinates along u, v and t from its center: x,
/// y, h. These are rho cos, rho sin and height, but in central sections the same divided by height.
struct SectionSums {
  /// int dS times 1, x, y, h over a plane face.
  struct OnPlane {
    double sums[4];
  };
  /// int weight times 1, x, y, h, xx, xy, yy, xh, yh, hh over a round face, where weight times half
  /// the gradient is the area vector, and its area.
  struct OnRound {
    double sums[10];
    double area;
  };
  /// int dV times 1, x, y, h, xx, xy, yy, xh, yh, hh.
  double moments[10];
  double depth_moment;
  /// Over the wall of a bore, where dw = |u| |v| dh d(angle), times h in central sections: int dw
  /// times 1, x, y, xx, xy, yy, x h, y h.
  struct OnBore {
    double wall, x, y, xx, xy, yy, xh, yh;
    double depth_moment;      ///< int depth dV
    double depth_x, depth_y;  ///< the same times x, y of the direction of the half-plane
    double depth;             ///< the largest: of rho - 1, times h in central sections
  };
  OnBore bore;
  /// Of the places seen, one of the least height and one of the largest.
  struct Place {
    double x, y, h;
  };
  Place low, high;
  OnRound rounds[SectionFaces::kMaxRounds];
  OnPlane* planes;  ///< as many as there are active planes
};

/// Both solids seen from the axis of a set of sections, which must pass through their overlap:
/// `center` inside of every face; from that of central sections it must be seen in front. Or the
/// axis of a bore, of radius rho = 1, with u and v normal to each other and of one length: what
/// lies within it does not count, and only half-planes that cut the overlap of the bodies at the
/// wall do. The bore is a tube, or in central sections a cone about t with its apex in the center.
/// Integrates columns over half-planes, eight at a time.
///
/// In one half-plane every face is a line or an arc, height over rho, and the overlap is what lies
/// above the lower and below the upper ones. Where it ends, and where one face takes over from
/// another, are crossings of two of them: between those places Gauss quadrature converges fast.
/// docs/theory.md, "Lines".
class Sections {
 public:
  /// `idle` planes cannot touch the overlap; they only say how far the solids reach over it.
  void set(const FaceSet& faces, const std::vector<PlaneFace>& idle, const SectionFrame& frame);
  const SectionFaces& faces() const { return faces_; }
  /// For a relative error of the volume. Area vectors converge less fast than volumes: with five
  /// nodes they are off by 1e-7 to 1e-4.
  void choose_rule(double tolerance);
  /// Of the rule along a half-plane, of V.
  double inner_error() const {
    return faces_.two_round && !faces_.fine ? outer_rule::kNearTurnError : outer_rule::kInnerError;
  }
  /// For what set() brings next: looks for more changes of face in a half-plane, and has eight
  /// nodes between them.
  void look_closer();

  /// Largest rho of the overlap in eight directions (u, v), of any length but zero, and the height
  /// of the middle of the column there.
  void ends(SimdPath path, const double* u, const double* v, double* rho, double* height);

  /// Sums over eight half-planes, lane i standing for directions (u, v) within `weight`: it counts
  /// weight int rho d rho. `section` gets the volume of each per weight.
  void integrate(SimdPath path, const double* u, const double* v, const double* weight,
                 double* section);

  /// What the last integrate() summed up, and the sum of all that was accepted.
  const SectionSums& batch() const { return batch_; }
  const SectionSums& total() const { return total_; }
  void accept_batch();
  /// Forgets what was accepted.
  void clear();

 private:
  void clear(SectionSums& sums, std::vector<SectionSums::OnPlane>& planes) const;

  struct Seen {
    SectionPlane plane;
    int group;
  };
  SectionFaces faces_;
  std::vector<Seen> seen_;
  std::vector<SectionPlane> planes_;
  SectionSums batch_, total_;
  std::vector<SectionSums::OnPlane> batch_planes_, total_planes_;
  struct alignas(64) Lane {
    double x[kLanes];
  };
  std::vector<Lane> work_;
};

}  // namespace volcontact
