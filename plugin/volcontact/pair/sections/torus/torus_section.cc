// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_section.h"

#include <algorithm>

#include "volcontact/pair/sections/section_limits.h"

namespace volcontact {
namespace {

using namespace section_limits;
constexpr double kOnSilhouette = 1e-6;  // a root this small is zero, per the largest one
constexpr double kBeforeWall = 1e-10;   // of the section: there a tube along the columns is open
constexpr int kLeastMiddleSteps = 3;    // of the search for a long column
constexpr int kMiddleSteps = 45;        // narrow it to 4e-10 of the disc
constexpr double kBeyondDomain = 1.000001;  // where a section ends at least, rounding included

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/sections/torus/torus_section_kernel.inc"
#include "volcontact/base/simd_paths.inc"

namespace volcontact {

void TorusSection::clear(TorusSums& sums, std::vector<SectionSums::OnPlane>& planes) const {
  sums = TorusSums{};
  sums.least_inside = faces_.minor * faces_.minor;
  planes.assign(static_cast<std::size_t>(faces_.sections.active_planes), SectionSums::OnPlane{});
  sums.planes = planes.data();
}

void TorusSection::accept_batch() {
  for (int i = 0; i < 10; ++i) total_.moments[i] += batch_.moments[i];
  total_.radial += batch_.radial;
  total_.area += batch_.area;
  for (int i = 0; i < 3; ++i) total_.vector[i] += batch_.vector[i];
  for (int i = 0; i < 2; ++i) total_.moment[i] += batch_.moment[i];
  for (int i = 0; i < 3; ++i) total_.across_rho[i] += batch_.across_rho[i];
  total_.least_inside = std::min(total_.least_inside, batch_.least_inside);
  for (int i = 0; i < faces_.sections.round_count; ++i) {
    for (int k = 0; k < 9; ++k) total_.rounds[i].sums[k] += batch_.rounds[i].sums[k];
    total_.rounds[i].area += batch_.rounds[i].area;
  }
  for (int i = 0; i < faces_.sections.active_planes; ++i) {
    for (int k = 0; k < 4; ++k) total_.planes[i].sums[k] += batch_.planes[i].sums[k];
  }
}

void TorusSection::set(const FaceSet& faces, double major_radius, double minor_radius) {
  sections_.set(faces, no_idle_, {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()});
  faces_.sections = sections_.faces();
  faces_.major = major_radius;
  faces_.minor = minor_radius;
  for (std::size_t i = 0; i < faces.rounds.size(); ++i) {
    const RoundFace& round = faces.rounds[i];
    const Vec3 row = round.map.row(2);
    faces_.nappes[i] = {round.cone, -row.dot(round.center), row.x(), row.y(), row.z()};
  }
  SectionFaces& sections = faces_.sections;
  SectionRound tube{};
  tube.lower = -1;
  tube.upper = 1;
  tube.owner = index(Owner::kA);
  tube.part = CapsulePart::kNone;
  sections.rounds[sections.round_count++] = tube;
  sections.two_round = faces.has_rounds(Owner::kB);
  sections.rounding = std::max(sections.rounding, 1e-14 * minor_radius);
  clear();
  const std::size_t on_planes = static_cast<std::size_t>(sections.active_planes) *
                                sizeof(portable::TorusBatch::OnPlane) / sizeof(portable::Vec8);
  const std::size_t size =
      static_cast<std::size_t>(portable::SectionSlices::work_size(sections)) + on_planes;
  if (work_.size() < size) work_.resize(size);
}

void TorusSection::probe(SimdPath path, const double* cos, const double* sin, double* length) {
  VOLCONTACT_SIMD_CALL(path, probe, faces_, work_.data()->x, cos, sin, length);
}

void TorusSection::integrate(SimdPath path, const double* cos, const double* sin,
                             const double* angle, double* section) {
  clear(batch_, batch_planes_);
  VOLCONTACT_SIMD_CALL(path, integrate, faces_, work_.data()->x, cos, sin, angle, batch_, section);
}

}  // namespace volcontact
