// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_in_composed.h"

#include "volcontact/pair/sections/region_join.h"

namespace volcontact {
namespace {

constexpr int kPlaces = 64;        // looked at on the circle of a torus
constexpr int kMostMoves = 10;     // of a place into the torus
constexpr double kBeneath = 1e-3;  // its surface, per radius of the tube
constexpr double kLevel = 1e-6;    // squared slope of a distance that leads nowhere

// False when the torus, a union of balls about its circle, keeps away from a bore; places on the
// circle may lie half a step from those looked at.
bool reaches(const Torus& torus, const Bore& bore) {
  const double R = torus.major_radius(), r = torus.minor_radius();
  const double slack = r + R * kPi / kPlaces;
  const double steep = std::sqrt(1.0 + bore.slope * bore.slope);
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = 2.0 * kPi * i / kPlaces;
    const Vec3 x(R * std::cos(angle), R * std::sin(angle), 0.0);
    const double across = bore.from_axis(x).norm();
    // From the wall of a tube, or of a cone, at whose apex this is too little.
    const double way =
        bore.is_cone() ? (across - bore.slope * bore.height(x)) / steep : across - bore.radius;
    if (way < slack) return true;
  }
  return false;
}

// The middle of a patch, or where the patch is bent about it, a place of the torus near by in the
// plane of the patch.
Vec3 place_of(const Torus& torus, const LinesRegion::PlanePatch& patch) {
  Vec3 x = patch.centroid;
  for (int i = 0; i < kMostMoves; ++i) {
    const double distance = torus.signed_distance(x);
    if (!(distance > 0.0)) break;
    const Vec3 gradient = torus.gradient(x);
    const Vec3 along = gradient - patch.normal * patch.normal.dot(gradient);
    const double slope = along.squaredNorm();
    if (!(slope > kLevel)) break;
    x -= (distance + kBeneath * torus.minor_radius()) / slope * along;
  }
  return x;
}

}  // namespace

bool torus_in_composed(const Torus& torus, const Pose& X_AB, const InterferenceOptions& options,
                       TorusSectionsScratch& ring, ComposedScratch& scratch, Interference& out) {
  LinesRegions& regions = scratch.regions;
  regions.cut(0);
  out.sites.clear();
  out.total = VolumeMetrics{};
  if (!(torus.own_metrics().volume > 0.0)) return true;
  const Pose X_BA = X_AB.inverse();
  const std::vector<LinesPiece>& pieces = scratch.pieces[1];
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const LinesPiece& piece = pieces[i];
    const std::size_t before = regions.size();
    if (!add_torus_regions(torus, piece.body, X_AB * piece.X_SB, options, ring, regions,
                           TorusSurface::kTorus)) {
      return false;
    }
    if (regions.size() == before) continue;
    if (piece.bores) {
      for (const Bore& bore : *piece.bores) {
        if (reaches(torus, transformed(bore, X_BA))) return false;
      }
    }
    for (std::size_t k = before; k < regions.size(); ++k) {
      regions[k].piece[1] = static_cast<int>(i);
      std::erase_if(regions[k].patches, [&](const LinesRegion::PlanePatch& patch) {
        return !(patch.area > 0.0) || !lies_in_seam(patch, piece.seams, X_AB);
      });
    }
  }
  const auto holds = [&](const LinesRegion& region, const LinesRegion::PlanePatch& patch) {
    const double slack = patch_slack(patch);
    const LinesPiece& piece = pieces[region.piece[1]];
    const Vec3 x = place_of(torus, patch);
    const RayInterval span = piece.body.ray(X_AB * piece.X_SB, x, patch.normal);
    return !span.empty() && span.enter <= slack && span.leave >= -slack &&
           torus.signed_distance(x) <= slack;
  };
  join_regions(regions, scratch.site_of, holds, out);
  return true;
}

}  // namespace volcontact
