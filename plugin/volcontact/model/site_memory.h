// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volcontact/base/types.h"
#include "volcontact/force/law_state.h"
#include "volcontact/metrics/volume_metrics.h"

namespace volcontact {

/// What is kept of one contact site beside the states of its laws: by this a site is found again,
/// and the way of the bodies since then is known. In memory a row is these numbers, then the states
/// of the normal law, then those of the friction law.
struct SiteHead {
  double pair = 0.0;           ///< index of the geometric pair in its contact model
  double volume = 0.0;         ///< V [m^3]
  double radius = 0.0;         ///< of the site, for the search: twice its radius of gyration [m]
  double point_A[3] = {};      ///< centroid in body A [m]
  double normal_W[3] = {};     ///< contact normal in the world
  double rotation_AB[9] = {};  ///< of B in A, by columns
  double origin_B_A[3] = {};   ///< origin of B in A [m]
};
inline constexpr int kSiteHead = sizeof(SiteHead) / sizeof(double);

/// The rows of a contact model as they were `elapsed` seconds ago. The numbers belong to the
/// caller.
struct SiteMemory {
  const double* rows = nullptr;
  int count = 0;
  int stride = 0;        ///< from row to row, at least the model's row_size()
  double elapsed = 0.0;  ///< [s], >= 0
};

/// How two bodies stand and move: poses and twists of the two body frames in the world.
struct BodyMotion {
  Pose X_WA;
  Pose X_WB;
  Twist V_WA;
  Twist V_WB;
};

/// What a site that is there now brings along.
struct CarriedSite {
  Vec3 travel = Vec3::Zero();    ///< way of A against B at the site since then, world frame [m]
  Vec3 rotation = Vec3::Zero();  ///< turn of A against B since then, world frame [rad]
};

/// Finds the sites of one geometric pair again and carries what their laws keep over to now.
/// docs/theory.md, "Memory of a site". Reuses its memory from call to call.
class SiteCarrier {
 public:
  /// `states` are the tables of the laws, one after the other as in a row.
  void carry(const SiteMemory& memory, int pair, std::span<const VolumeMetrics> sites_W,
             const BodyMotion& motion, std::span<const StateField> states);

  const CarriedSite& site(std::size_t i) const { return carried_[i]; }
  /// Committed states of site i.
  const double* states(std::size_t i) const { return states_.data() + i * size_; }

 private:
  struct Old {
    const double* row;
    Vec3 predicted;  // where its centroid would be now, if it went half with A and half with B
    double reach;    // how far from there it may be
    CarriedSite way;
    double children;  // summed volume of the sites that came of it [m^3]
  };

  void predict(const SiteMemory& memory, int pair, const BodyMotion& motion);
  void link(std::span<const VolumeMetrics> sites_W);
  void inherit(std::size_t site, const VolumeMetrics& metrics_W, const BodyMotion& motion,
               double elapsed, std::span<const StateField> states);

  std::size_t size_ = 0;
  std::vector<Old> old_;
  std::vector<char> links_;  // old times new
  std::vector<CarriedSite> carried_;
  std::vector<double> states_;
};

/// The head of the row of a site that is there now.
SiteHead site_head(int pair, const VolumeMetrics& metrics_W, const BodyMotion& motion) noexcept;

}  // namespace volcontact
