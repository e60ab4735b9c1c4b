// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/section_metrics.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

struct Surface {
  Vec3 vector = Vec3::Zero(), moment = Vec3::Zero();
  double area = 0.0;
};

void add_planes(const Sections& sections, const FaceSet& faces, const SectionFrame& frame,
                Owner owner, Surface& s) {
  for (int i = 0; i < sections.faces().active_planes; ++i) {
    const PlaneFace& plane = faces.planes[sections.faces().planes[i].face];
    if (plane.owner != owner) continue;
    const double* x = sections.total().planes[i].sums;
    s.area += x[0];
    s.vector += x[0] * plane.normal;
    s.moment += (x[1] * frame.u + x[2] * frame.v + x[3] * frame.t).cross(plane.normal);
  }
}

void add_rounds(const Sections& sections, const SectionFrame& frame, Owner owner, Surface& s) {
  const Vec3 &u = frame.u, &v = frame.v, &t = frame.t;
  for (int i = 0; i < sections.faces().round_count; ++i) {
    const SectionRound& r = sections.faces().rounds[i];
    if (r.owner != index(owner)) continue;
    const double* x = sections.total().rounds[i].sums;
    const Vec3 g(r.g), g_u(r.g_u), g_v(r.g_v), g_t(r.g_t);
    s.area += sections.total().rounds[i].area;
    s.vector += x[0] * g + x[1] * g_u + x[2] * g_v + x[3] * g_t;
    s.moment +=
        (x[1] * u + x[2] * v + x[3] * t).cross(g) + (x[4] * u + x[5] * v + x[7] * t).cross(g_u) +
        (x[5] * u + x[6] * v + x[8] * t).cross(g_v) + (x[7] * u + x[8] * v + x[9] * t).cross(g_t);
  }
}

// The wall of a bore about t, which looks towards the axis: at rho = 1 in half-plane e = u cos + v
// sin it is t h, of central sections h (e + t).
void add_bore(const Sections& sections, const SectionFrame& frame, Surface& s) {
  const SectionSums::OnBore& b = sections.total().bore;
  const double r2 = frame.u.squaredNorm(), length = frame.central ? frame.t.norm() : 1.0;
  const Vec3 out = (b.x * frame.u + b.y * frame.v) / r2;
  const Vec3 turn = frame.t.cross(b.xh * frame.u + b.yh * frame.v) / r2;
  if (!frame.central) {
    s.area += b.wall / std::sqrt(r2);
    s.vector -= out;
    s.moment -= turn;
    return;
  }
  const double square = length * length;
  s.area += b.wall * std::sqrt(1.0 / r2 + 1.0 / square);
  s.vector += b.wall / square * frame.t - out;
  s.moment -= (1.0 + r2 / square) * turn;
}

Surface surface_of(const Sections& sections, const FaceSet& faces, const SectionFrame& frame,
                   Owner owner) {
  Surface s;
  add_planes(sections, faces, frame, owner, s);
  add_rounds(sections, frame, owner, s);
  if (faces.has_bore && faces.wall.owner == owner) add_bore(sections, frame, s);
  return s;
}

constexpr double kLonger = 1.001;  // than an area, which a vector cannot be

// From which solid the area vector is taken: plane faces give it best. The error of a vector goes
// with its area, and a small area, as that of a rod's ends, bounds what the vector can be.
double share_of_b(const Surface& a, const Surface& b, const FaceSet& faces) {
  const bool flat_a = !faces.has_rounds(Owner::kA), flat_b = !faces.has_rounds(Owner::kB);
  if (flat_a != flat_b) {
    const Surface &flat = flat_a ? a : b, &round = flat_a ? b : a;
    const bool from_flat = flat.vector.norm() <= kLonger * round.area;
    return from_flat == flat_b ? 1.0 : 0.0;
  }
  const double square_a = a.area * a.area, square_b = b.area * b.area;
  return square_a + square_b > 0.0 ? square_a / (square_a + square_b) : 0.5;
}

}  // namespace

MomentSum moments_of(const Sections& sections, const FaceSet& faces, const SectionFrame& frame) {
  const double* m = sections.total().moments;
  const Vec3 &u = frame.u, &v = frame.v, &t = frame.t;
  const auto both = [](const Vec3& x, const Vec3& y) -> Mat3 { return outer(x, y) + outer(y, x); };
  MomentSum sum;
  sum.volume = m[0];
  sum.first = u * m[1] + v * m[2] + t * m[3];
  sum.second = outer(m[4] * u, u) + m[5] * both(u, v) + outer(m[6] * v, v) + m[7] * both(u, t) +
               m[8] * both(v, t) + outer(m[9] * t, t);
  const Surface surface[2] = {surface_of(sections, faces, frame, Owner::kA),
                              surface_of(sections, faces, frame, Owner::kB)};
  const double share_b = share_of_b(surface[0], surface[1], faces);
  sum.area_vector = (1.0 - share_b) * surface[0].vector - share_b * surface[1].vector;
  sum.area_moment = (1.0 - share_b) * surface[0].moment - share_b * surface[1].moment;
  sum.area = surface[0].area;
  sum.counter_area = surface[1].area;
  return sum;
}

void SurfaceFlux::add_round(const SectionRound& r, const double* x) {
  const Vec3 g(r.g), g_u(r.g_u), g_v(r.g_v), g_t(r.g_t);
  for (int k = 0; k < 2; ++k) {
    const Vec3& axis = axes_[k];
    flux_[k] += Vec3(x[0], x[1], x[2]) * g.dot(axis) + Vec3(x[1], x[4], x[5]) * g_u.dot(axis) +
                Vec3(x[2], x[5], x[6]) * g_v.dot(axis) + Vec3(x[3], x[7], x[8]) * g_t.dot(axis);
  }
}

double SurfaceFlux::open(double volume, double middle_x, double middle_y, double size) const {
  double most = 0.0;
  for (int k = 0; k < 2; ++k) {
    const double one = flux_[k][0];
    const double along_x = flux_[k][1] - middle_x * one - (k == 0 ? volume : 0.0);
    const double along_y = flux_[k][2] - middle_y * one - (k == 1 ? volume : 0.0);
    most = std::max({most, std::abs(size * one), std::abs(along_x), std::abs(along_y)});
  }
  return most;
}

namespace {

// Through the faces, and through what else there is.
SurfaceFlux flux_of(const Sections& sections, const FaceSet& faces, const SectionFrame& frame,
                    const SurfaceFlux::Axes& other) {
  SurfaceFlux flux({frame.u, frame.v});
  for (int i = 0; i < sections.faces().active_planes; ++i) {
    flux.add_plane(faces.planes[sections.faces().planes[i].face].normal,
                   sections.total().planes[i].sums);
  }
  for (int i = 0; i < sections.faces().round_count; ++i) {
    flux.add_round(sections.faces().rounds[i], sections.total().rounds[i].sums);
  }
  flux.add(other);
  return flux;
}

}  // namespace

double openness(const Sections& sections, const FaceSet& faces, const SectionFrame& frame) {
  return flux_of(sections, faces, frame, {Vec3::Zero(), Vec3::Zero()})
      .open(sections.total().moments[0]);
}

double bore_openness(const Sections& sections, const FaceSet& faces, const SectionFrame& frame) {
  const Surface a = surface_of(sections, faces, frame, Owner::kA),
                b = surface_of(sections, faces, frame, Owner::kB);
  const double area = 0.5 * (a.area + b.area), volume = sections.total().moments[0];
  if (!(area > 0.0)) return 0.0;
  double gap = (a.vector + b.vector).norm();
  if (!frame.central) {
    // The wall is at rho = 1, where n dS is -(u cos + v sin) dw / |u|^2.
    const SectionSums::OnBore& w = sections.total().bore;
    const SurfaceFlux::Axes wall = {Vec3(-w.x, -w.xx, -w.xy), Vec3(-w.y, -w.xy, -w.yy)};
    gap = std::max(gap, flux_of(sections, faces, frame, wall).open(volume) / frame.u.norm());
  }
  return gap / area * volume;
}

double share_of_bore(const Sections& sections, const FaceSet& faces, const SectionFrame& frame) {
  constexpr double kBalanced = 1e-3;  // weight of areas where all area vectors vanish
  Surface wall, rest;
  add_bore(sections, frame, wall);
  add_planes(sections, faces, frame, faces.wall.owner, rest);
  add_rounds(sections, frame, faces.wall.owner, rest);
  const double on_wall = wall.vector.squaredNorm() + kBalanced * wall.area * wall.area;
  const double on_rest = rest.vector.squaredNorm() + kBalanced * rest.area * rest.area;
  return on_wall > 0.0 ? on_wall / (on_wall + on_rest) : 0.0;
}

void add_patches(const Sections& sections, const FaceSet& faces, const SectionFrame& frame,
                 std::vector<LinesRegion::PlanePatch>& patches) {
  for (int i = 0; i < sections.faces().active_planes; ++i) {
    const PlaneFace& plane = faces.planes[sections.faces().planes[i].face];
    const double* x = sections.total().planes[i].sums;
    if (!(x[0] > 0.0)) continue;
    const Vec3 first = x[1] * frame.u + x[2] * frame.v + x[3] * frame.t;
    patches.push_back({plane.owner, plane.normal, plane.offset, x[0], frame.center + first / x[0]});
  }
}

}  // namespace volcontact
