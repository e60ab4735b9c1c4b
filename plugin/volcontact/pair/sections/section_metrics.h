// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/sections/section.h"
#include "volcontact/pair/sections/section_region.h"

namespace volcontact {

/// The sums of a set of sections in A's axes, about the center of its frame. The area vector is
/// taken from the solid whose faces give it best: plane ones and the wall of a bore.
MomentSum moments_of(const Sections& sections, const FaceSet& faces, const SectionFrame& frame);

/// Flux of 1, x and y through the surface of an overlap, along two axes e and f across the columns.
/// By the theorem of Gauss int n dS vanishes and int x_i n_j dS is V or nothing. Columns see to
/// that only along themselves; across them the normals come from the gradients of the faces. So the
/// surface is closed only where no change of face was overlooked, in a half-plane or between two.
class SurfaceFlux {
 public:
  using Axes = std::array<Vec3, 2>;
  explicit SurfaceFlux(const Axes& axes) : axes_(axes) {}

  /// `sums`: of 1, x and y over the face.
  void add_plane(const Vec3& normal, const double* sums) {
    for (int k = 0; k < 2; ++k) {
      flux_[k] += Vec3(sums[0], sums[1], sums[2]) * normal.dot(axes_[k]);
    }
  }
  void add_round(const SectionRound& round, const double* sums);
  /// Along e and along f, each of 1, x and y.
  void add(const Axes& flux) {
    for (int k = 0; k < 2; ++k) flux_[k] += flux[k];
  }

  /// How far from closed the surface is, as an error of V, which is `volume`. Seen from a middle,
  /// of an overlap about `size` long in x and y.
  double open(double volume, double middle_x = 0.0, double middle_y = 0.0, double size = 1.0) const;

 private:
  Axes axes_, flux_ = {Vec3::Zero(), Vec3::Zero()};
};

/// The same of a set of sections without a bore.
double openness(const Sections& sections, const FaceSet& faces, const SectionFrame& frame);

/// The same with a bore, of which the overlap may be a thin layer: the gap as a share of the
/// surface, and of V. From the apex of a cone flux of 1 alone is looked at.
double bore_openness(const Sections& sections, const FaceSet& faces, const SectionFrame& frame);

/// Which share of the push on the owner of a bore comes from its wall, from 0 to 1.
double share_of_bore(const Sections& sections, const FaceSet& faces, const SectionFrame& frame);

/// The parts of the surface that lie in plane faces, in A's frame.
void add_patches(const Sections& sections, const FaceSet& faces, const SectionFrame& frame,
                 std::vector<LinesRegion::PlanePatch>& patches);

}  // namespace volcontact
