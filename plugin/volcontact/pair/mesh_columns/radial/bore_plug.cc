// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/bore_plug.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr double kWithin = 1e-9;  // of the plug's size: its rims lie in faces of the body
constexpr int kRimSamples = 16;

// Whether the other faces of the body leave the plug alone: it is convex, so its rims tell.
bool lies_within(const BorePlug& plug, const RadialSolid& solid) {
  for (int i = 0; i < kRimSamples; ++i) {
    const double angle = 2.0 * kPi * i / kRimSamples;
    for (const bool up : {false, true}) {
      const double r = up ? plug.top : plug.bottom;
      const Vec3 p(r * std::cos(angle), r * std::sin(angle), up ? plug.high : plug.low);
      for (const RoundFace& round : solid.rounds) {
        if (round(p) > kWithin) return false;
      }
      for (const SurfacePlane& plane : solid.planes) {
        if (plane.normal.dot(p) - plane.offset > kWithin * (r + plug.high - plug.low)) return false;
      }
    }
  }
  return true;
}

MomentSum sum_of(const VolumeMetrics& m, double sign) {
  MomentSum sum;
  const Vec3 first = m.volume * m.centroid;
  sum.volume = sign * m.volume;
  sum.first = sign * first;
  sum.second = sign * (m.second_moment() + outer(first, m.centroid));
  sum.area_vector = sign * m.area_vector;
  sum.area_moment = sign * m.area_moment;
  sum.area = sign * m.area;
  return sum;
}

}  // namespace

std::optional<BorePlug> bore_plug(const RadialSolid& solid, double lowest, double highest) {
  double low = -kInfinity, high = kInfinity;
  for (int i = 0; i < solid.planes_across; ++i) {
    const SurfacePlane& plane = solid.planes[static_cast<std::size_t>(i)];
    if (plane.normal.z() > 0.0) {
      high = std::min(high, plane.offset);
    } else {
      low = std::max(low, -plane.offset);
    }
  }
  const bool ends = std::isfinite(low) && std::isfinite(high);
  BorePlug plug{std::max(low, lowest), std::min(high, highest), 0.0, 0.0, false};
  plug.bottom = solid.wall.radius + solid.wall.slope * plug.low;
  plug.top = solid.wall.radius + solid.wall.slope * plug.high;
  if (!(plug.high > plug.low && plug.bottom > 0.0 && plug.top > 0.0)) return std::nullopt;
  plug.exact = ends && lies_within(plug, solid);
  return plug;
}

VolumeMetrics without(const VolumeMetrics& m, const VolumeMetrics& part) {
  MomentSum sum = sum_of(m, 1.0);
  sum += sum_of(part, -1.0);
  VolumeMetrics rest = sum.metrics();
  rest.area = std::max(0.0, sum.area);
  rest.depth_moment = std::max(0.0, m.depth_moment - part.depth_moment);
  rest.depth = m.depth;
  rest.volume_error = m.volume_error + part.volume_error;
  rest.status = part.status == Status::kContained ? m.status : std::max(m.status, part.status);
  return rest;
}

}  // namespace volcontact
