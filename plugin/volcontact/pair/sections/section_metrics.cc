// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/section_metrics.h"

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
  const auto both = [](const Vec3& x, const Vec3& y) -> Mat3 {
    return x * y.transpose() + y * x.transpose();
  };
  MomentSum sum;
  sum.volume = m[0];
  sum.first = u * m[1] + v * m[2] + t * m[3];
  sum.second = m[4] * u * u.transpose() + m[5] * both(u, v) + m[6] * v * v.transpose() +
               m[7] * both(u, t) + m[8] * both(v, t) + m[9] * t * t.transpose();
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
  Mat3 gradient, sums;  // of 1, x, y, times the same
  gradient << Vec3(r.g), Vec3(r.g_u), Vec3(r.g_v);
  sums << x[0], x[1], x[2], x[1], x[4], x[5], x[2], x[5], x[6];
  flux_ += sums * (gradient.transpose() * axes_) +
           Vec3(x[3], x[7], x[8]) * (Vec3(r.g_t).transpose() * axes_);
}

double SurfaceFlux::open(double volume, const Eigen::Vector2d& middle, double size) const {
  Axes rest = flux_;
  rest.bottomRows<2>() -= middle * flux_.row(0);
  rest.row(0) *= size;
  rest(1, 0) -= volume;
  rest(2, 1) -= volume;
  return rest.cwiseAbs().maxCoeff();
}

namespace {

// Through the faces, and through what else there is.
SurfaceFlux flux_of(const Sections& sections, const FaceSet& faces, const SectionFrame& frame,
                    const SurfaceFlux::Axes& other) {
  SurfaceFlux flux((SurfaceFlux::Axes() << frame.u, frame.v).finished());
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
  return flux_of(sections, faces, frame, SurfaceFlux::Axes::Zero())
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
    SurfaceFlux::Axes wall;
    wall << -w.x, -w.y, -w.xx, -w.xy, -w.xy, -w.yy;
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
