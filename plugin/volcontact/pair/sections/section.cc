// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/section.h"

#include <algorithm>
#include <array>
#include <utility>

#include "volcontact/pair/sections/section_limits.h"

namespace volcontact {
namespace {

using namespace section_limits;
constexpr double kSteep = 1e-9;  // a plane whose normal is this normal to the columns is a wall
constexpr double kOnSilhouette = 1e-6;  // a root this small is zero, per the largest one
constexpr double kBeforeWall = 1e-10;   // of rho: there the tube along the columns is wide open
constexpr double kWallTilt = 3e-8;      // a tube tilted less against the columns is a wall [rad]
constexpr double kSameApex = 1e-10;     // a cone whose apex is this near to the center is a wall

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/sections/section_kernel.inc"
#include "volcontact/base/simd_paths.inc"

namespace volcontact {

SectionFrame round_frame(const Vec3& center, const Mat3& spread, const Vec3& t) {
  const Mat3 basis = basis_with_z(t);
  // How the spread is seen along t, as a triangle: the rest of y is taken before it is squared, for
  // of a thin one the difference of squares is nothing but rounding.
  const Mat3 seen = spread.transpose() * basis;
  const Vec3 x = seen.col(0), y = seen.col(1);
  const double across = x.norm(), along = across > 0.0 ? x.dot(y) / across : 0.0;
  const Vec3 rest = across > 0.0 ? Vec3(y - along / across * x) : y;
  return {center, basis.col(0) * across + basis.col(1) * along, basis.col(1) * rest.norm(), t};
}

void Sections::clear(SectionSums& sums, std::vector<SectionSums::OnPlane>& planes) const {
  std::fill_n(sums.moments, 10, 0.0);
  sums.depth_moment = 0.0;
  sums.bore = {};
  std::fill_n(sums.rounds, faces_.round_count, SectionSums::OnRound{});
  sums.low = {0.0, 0.0, kFar};
  sums.high = {0.0, 0.0, -kFar};
  planes.assign(faces_.active_planes, SectionSums::OnPlane{});
  sums.planes = planes.data();
}

void Sections::accept_batch() {
  for (int i = 0; i < 10; ++i) total_.moments[i] += batch_.moments[i];
  total_.depth_moment += batch_.depth_moment;
  total_.bore.depth_moment += batch_.bore.depth_moment;
  total_.bore.depth_x += batch_.bore.depth_x;
  total_.bore.depth_y += batch_.bore.depth_y;
  total_.bore.depth = std::max(total_.bore.depth, batch_.bore.depth);
  total_.bore.wall += batch_.bore.wall;
  total_.bore.x += batch_.bore.x;
  total_.bore.y += batch_.bore.y;
  total_.bore.xx += batch_.bore.xx;
  total_.bore.xy += batch_.bore.xy;
  total_.bore.yy += batch_.bore.yy;
  total_.bore.xh += batch_.bore.xh;
  total_.bore.yh += batch_.bore.yh;
  if (batch_.low.h < total_.low.h) total_.low = batch_.low;
  if (batch_.high.h > total_.high.h) total_.high = batch_.high;
  for (int i = 0; i < faces_.active_planes; ++i) {
    for (int k = 0; k < 4; ++k) total_.planes[i].sums[k] += batch_.planes[i].sums[k];
  }
  for (int i = 0; i < faces_.round_count; ++i) {
    for (int k = 0; k < 10; ++k) total_.rounds[i].sums[k] += batch_.rounds[i].sums[k];
    total_.rounds[i].area += batch_.rounds[i].area;
  }
}

namespace {

// Which group a plane face belongs to; kGroups: none.
int group_of(double n_t, Owner owner, bool idle) {
  const bool upper = n_t > 0.0, a = owner == Owner::kA, wall = std::abs(n_t) < kSteep;
  if (idle) {
    if (wall || a == upper) return SectionFaces::kGroups;
    return a ? SectionFaces::kIdleLowerA : SectionFaces::kIdleUpperB;
  }
  if (wall) return SectionFaces::kWall;
  if (a) return upper ? SectionFaces::kUpperA : SectionFaces::kLowerA;
  return upper ? SectionFaces::kUpperB : SectionFaces::kLowerB;
}

void put(const Vec3& x, double* out) {
  for (int i = 0; i < 3; ++i) out[i] = x[i];
}

// The places where columns pierce a face: the roots of a z^2 + 2 b z + c, where z is the height. Of
// the three images under the map of the face one goes with z, `ahead`, and one does not, `base`;
// `side_u` and `side_v` come with rho. The level of the face goes with z^2 or does not.
SectionRound pierced(const RoundFace& face, const Vec3& ahead, const Vec3& base, const Vec3& side_u,
                     const Vec3& side_v, bool level_ahead) {
  SectionRound r;
  const Vec3 dj = face.weighted(ahead);
  const double a = ahead.dot(dj) - (level_ahead ? face.level() : 0.0);
  const double cone = face.cone ? -1.0 : 1.0;
  r.squares = 3;
  for (int i = 0; i < 3; ++i) r.sign[i] = i < 2 ? cone : 1.0;
  // Of central sections the apex of a cone, or nearly so; else a tube along the columns.
  const double size = level_ahead ? base.squaredNorm() : face.map.squaredNorm();
  const double least = level_ahead ? kSameApex : kWallTilt;
  r.cone = face.cone;
  r.wall = level_ahead == face.cone && ahead.squaredNorm() < least * least * size;
  if (r.wall) {
    // The root is that of minus the face's function.
    r.mid = r.mid_u = r.mid_v = 0.0;
    if (face.cone) {
      r.sign[0] = r.sign[1] = 1.0;
      r.sign[2] = -1.0;
    }
    put(base, r.x);
    put(side_u, r.x_u);
    put(side_v, r.x_v);
    r.reach = face.level();
    r.weight = 1.0;
    r.lower = r.upper = 0;
    return r;
  }
  r.mid = -base.dot(dj) / a;
  r.mid_u = -side_u.dot(dj) / a;
  r.mid_v = -side_v.dot(dj) / a;
  put(ahead.cross(base) / a, r.x);
  put(ahead.cross(side_u) / a, r.x_u);
  put(ahead.cross(side_v) / a, r.x_v);
  r.reach = level_ahead ? 0.0 : face.level() / a;
  if (level_ahead && !face.cone) {
    r.squares = 6;
    put(base / a, r.x + 3);
    put(side_u / a, r.x_u + 3);
    put(side_v / a, r.x_v + 3);
    for (int i = 3; i < 6; ++i) r.sign[i] = -1.0;
  }
  r.weight = 1.0 / std::abs(a);
  const bool up = !face.cone || ahead.z() > 0.0, down = face.cone && ahead.z() < 0.0;
  r.lower = a > 0.0 ? -1 : up ? 1 : 0;
  r.upper = a > 0.0 ? 1 : down ? -1 : 0;
  return r;
}

SectionRound seen_from(const RoundFace& face, const SectionFrame& frame) {
  const Vec3 o = face.map * (frame.center - face.center);
  const Vec3 u = face.map * frame.u, v = face.map * frame.v, d = face.map * frame.t;
  SectionRound r =
      frame.central ? pierced(face, o, d, u, v, true) : pierced(face, d, o, u, v, false);
  const Mat3 back = face.map.transpose();
  put(back * face.weighted(o), r.g);
  put(back * face.weighted(u), r.g_u);
  put(back * face.weighted(v), r.g_v);
  put(back * face.weighted(d), r.g_t);
  r.owner = index(face.owner);
  r.part = face.part;
  return r;
}

// n_t height + rho (n_u cos + n_v sin) <= gap.
SectionPlane seen_from(const PlaneFace& plane, int face, const SectionFrame& frame) {
  const Vec3& n = plane.normal;
  const double along = n.dot(frame.t), gap = plane.offset - n.dot(frame.center);
  if (frame.central) return {n.dot(frame.u), n.dot(frame.v), -gap, -along, face};
  return {n.dot(frame.u), n.dot(frame.v), along, gap, face};
}

SectionSeam seen_from(const Segment& segment, const SectionFrame& frame) {
  SectionSeam seam{segment.present,
                   segment.along(frame.center),
                   segment.axis.dot(frame.u),
                   segment.axis.dot(frame.v),
                   segment.axis.dot(frame.t),
                   segment.half_length,
                   0.0};
  if (frame.central) {
    std::swap(seam.along, seam.along_t);
    std::swap(seam.half_length, seam.half_slope);
  }
  return seam;
}

}  // namespace

void Sections::set(const FaceSet& faces, const std::vector<PlaneFace>& idle,
                   const SectionFrame& frame) {
  seen_.clear();
  std::array<int, SectionFaces::kGroups> next{};  // sizes of the groups, then where they go on
  const double unit = frame.central ? frame.t.norm() : 1.0;
  for (const bool is_idle : {false, true}) {
    const std::vector<PlaneFace>& list = is_idle ? idle : faces.planes;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const SectionPlane plane = seen_from(list[i], static_cast<int>(i), frame);
      const int group = group_of(plane.n_t / unit, list[i].owner, is_idle);
      if (group == SectionFaces::kGroups) continue;
      seen_.push_back({plane, group});
      ++next[group];
    }
  }
  faces_.first[0] = 0;
  for (int group = 0; group < SectionFaces::kGroups; ++group) {
    faces_.first[group + 1] = faces_.first[group] + next[group];
    next[group] = faces_.first[group];
  }
  planes_.resize(seen_.size());
  for (const Seen& s : seen_) planes_[next[s.group]++] = s.plane;
  faces_.active_planes = faces_.first[SectionFaces::kIdleLowerA];
  faces_.planes = planes_.data();

  faces_.round_count = 0;
  faces_.rounding = faces_.plane_rounding = 0.0;
  for (int i = 0; i < faces_.first[SectionFaces::kWall]; ++i) {
    const SectionPlane& p = planes_[i];
    const double size = std::abs(p.gap) + std::abs(p.n_u) + std::abs(p.n_v);
    faces_.plane_rounding = std::max(faces_.plane_rounding, 1e-15 * size / std::abs(p.n_t));
  }
  for (const RoundFace& face : faces.rounds) {
    const SectionRound r = seen_from(face, frame);
    faces_.rounds[faces_.round_count++] = r;
    faces_.rounding =
        std::max(faces_.rounding, 1e-14 * (std::abs(r.mid) + std::sqrt(std::abs(r.reach))));
  }
  faces_.two_round = faces.has_rounds(Owner::kA) && faces.has_rounds(Owner::kB);
  for (int w = 0; w < 2; ++w) faces_.seams[w] = seen_from(faces.capsule[w], frame);
  faces_.central = frame.central;
  faces_.area_scale = frame.area_scale();
  faces_.start = faces.has_bore ? 1.0 : 0.0;
  clear();
  const std::size_t on_planes = faces_.active_planes * sizeof(portable::SectionBatch::OnPlane);
  const std::size_t size =
      portable::SectionSlices::work_size(faces_) + on_planes / sizeof(portable::Vec8);
  if (work_.size() < size) work_.resize(size);
}

void Sections::clear() { clear(total_, total_planes_); }

void Sections::choose_rule(double tolerance) {
  faces_.fine = tolerance <= kFineTolerance;
  faces_.knot_parts = kKnotParts;
}

void Sections::look_closer() {
  faces_.fine = true;
  faces_.knot_parts = kMoreKnotParts;
}

void Sections::ends(SimdPath path, const double* u, const double* v, double* rho, double* height) {
  VOLCONTACT_SIMD_CALL(path, ends, faces_, work_.data()->x, u, v, rho, height);
}

void Sections::integrate(SimdPath path, const double* u, const double* v, const double* weight,
                         double* section) {
  clear(batch_, batch_planes_);
  VOLCONTACT_SIMD_CALL(path, integrate, faces_, work_.data()->x, u, v, weight, batch_, section);
}

}  // namespace volcontact
