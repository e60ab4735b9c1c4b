// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "volcontact/base/interrupt.h"
#include "volcontact/shape/csg/csg_faces.h"
#include "volcontact/shape/csg/csg_lines.h"
#include "volcontact/shape/csg/csg_metrics.h"

namespace volcontact {
namespace {

// 1, x, y, z, xx, xy, xz, yy, yz, zz.
using Moments = Vector<10>;

constexpr double kOuterTolerance = 2e-10, kInnerTolerance = 2e-11;  // of the volume's scale
constexpr int kMostDepth = 40;

// Gauss-Kronrod rule of 7 and 15 points on [-1, 1] (QUADPACK, qk15).
constexpr std::array<double, 8> kNodes{
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691693002, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0.0};
constexpr std::array<double, 8> kKronrod{
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 4> kGauss{
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

// Sizes that make the moments comparable: powers of a length.
double error_of(const Moments& difference, double length) {
  double worst = std::abs(difference[0]);
  for (int i = 1; i < 4; ++i) worst = std::max(worst, std::abs(difference[i]) / length);
  for (int i = 4; i < 10; ++i) {
    worst = std::max(worst, std::abs(difference[i]) / (length * length));
  }
  return worst;
}

// int f over [low, high]. Between given ends y = low + (high - low)(3 s^2 - 2 s^3): a square root
// at an end, as every silhouette makes one, becomes smooth.
template <typename Function>
class Integral {
 public:
  Integral(Function& f, double length, double allowed)
      : f_(f), length_(length), allowed_(allowed) {}

  Moments over(double low, double high) {
    low_ = low;
    width_ = high - low;
    return part(0.0, 1.0, 0);
  }

 private:
  Moments at(double s) {
    return 6.0 * s * (1.0 - s) * width_ * f_(low_ + width_ * s * s * (3.0 - 2.0 * s));
  }

  // The 15-point rule on [a, b]; `error` is what the 7-point rule differs by.
  Moments rule(double a, double b, double& error) {
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    const Moments center = at(middle);
    Moments fine = kKronrod[7] * center, coarse = kGauss[3] * center;
    for (int i = 0; i < 7; ++i) {
      const Moments pair = at(middle - half * kNodes[i]) + at(middle + half * kNodes[i]);
      fine += kKronrod[i] * pair;
      if (i % 2 == 1) coarse += kGauss[i / 2] * pair;
    }
    error = half * error_of(fine - coarse, length_);
    return half * fine;
  }

  // A kink may hide from one pair of rules: the halves must agree with the whole as well.
  Moments part(double a, double b, int depth) {
    double error = 0.0;
    return refined(a, b, rule(a, b, error), error, depth);
  }
  Moments refined(double a, double b, const Moments& whole, double error, int depth) {
    const double middle = 0.5 * (a + b);
    double left_error = 0.0, right_error = 0.0;
    const Moments left = rule(a, middle, left_error), right = rule(middle, b, right_error);
    const double change = error_of(left + right - whole, length_);
    if (depth == kMostDepth || std::max({error, change, left_error + right_error}) <= allowed_) {
      return left + right;
    }
    return refined(a, middle, left, left_error, depth + 1) +
           refined(middle, b, right, right_error, depth + 1);
  }

  Function& f_;
  double length_, allowed_;
  double low_ = 0.0, width_ = 0.0;
};

// Work of a line, in units of a convex member: of a torus the roots are searched for.
constexpr double kTorusWork = 40.0;
double line_work(const Csg& solid) {
  double work = 0.0;
  for (const Csg::Member& member : solid.members()) {
    work += std::holds_alternative<Torus>(member.shape) ? kTorusWork : 1.0;
  }
  return work;
}

struct WorkEnds {};

class LineSum {
 public:
  LineSum(const Csg& solid, double most_work)
      : solid_(solid),
        box_(solid.bounds()),
        size_(size_of(solid)),
        lines_left_(most_work / line_work(solid)) {
    for (const Csg::Member& member : solid.members()) {
      for (const auto& part : member_faces(member.shape, member.X_SM)) {
        faces_.insert(faces_.end(), part.begin(), part.end());
      }
    }
    const Vec3 extent = box_.max - box_.min;
    length_ = extent.norm();
    scale_ = extent.prod();
  }

  // Throws WorkEnds.
  Moments all() {
    auto section = [this](double z) { return section_at(z); };
    Integral integral(section, length_, kOuterTolerance * scale_);
    return over(integral, z_ends(), box_.min.z(), box_.max.z());
  }

 private:
  template <typename I>
  Moments over(I& integral, std::vector<double> ends, double low, double high) {
    ends.insert(ends.end(), {low, high});
    std::sort(ends.begin(), ends.end());
    Moments sum = Moments::Zero();
    double from = low;
    for (const double to : ends) {
      if (!(to > from + 1e-13 * size_) || to > high) continue;
      sum += integral.over(from, to);
      from = to;
    }
    return sum;
  }

  // Where members begin and end, and corners of plane faces.
  std::vector<double> z_ends() const {
    std::vector<double> ends;
    for (const Csg::Member& member : solid_.members()) {
      const Vec3 e = member.X_SM.rotation.row(2);
      const double p = member.X_SM.translation.z();
      std::visit(
          [&](const auto& shape) {
            ends.insert(ends.end(), {p + shape.support_height(e), p - shape.support_height(-e)});
          },
          member.shape);
    }
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t k = 0; k < j; ++k) add_corner(faces_[i], faces_[j], faces_[k], ends);
      }
    }
    std::erase_if(ends, [](double z) { return !std::isfinite(z); });
    return ends;
  }

  void add_corner(const MemberFace& a, const MemberFace& b, const MemberFace& c,
                  std::vector<double>& ends) const {
    for (const MemberFace* face : {&a, &b, &c}) {
      if (face->kind != MemberFace::Kind::kPlane) return;
    }
    const Mat3 normals = Mat3::with_rows(a.quadric.linear, b.quadric.linear, c.quadric.linear);
    const double volume = normals.determinant();
    if (std::abs(volume) < 1e-9) return;
    const Vec3 corner =
        normals.inverse() * -Vec3(a.quadric.constant, b.quadric.constant, c.quadric.constant);
    if (on_surface(corner)) ends.push_back(corner.z());
  }

  bool on_surface(const Vec3& p) const {
    return std::abs(solid_.signed_distance(p)) <= 1e-9 * size_;
  }

  // Where lines touch a torus whose axis is z.
  void add_torus_sides(double z, std::vector<double>& ends) const {
    for (const Csg::Member& member : solid_.members()) {
      const auto* torus = std::get_if<Torus>(&member.shape);
      const double z_M = z - member.X_SM.translation.z(), y = member.X_SM.translation.y();
      if (!torus || std::abs(z_M) >= torus->minor_radius()) continue;
      const double half = std::sqrt(torus->minor_radius() * torus->minor_radius() - z_M * z_M);
      for (const double radius : {torus->major_radius() - half, torus->major_radius() + half}) {
        ends.insert(ends.end(), {y - radius, y + radius});
      }
    }
  }

  // y where a line's end jumps or has a kink: sides of round faces, edges of faces.
  std::vector<double> y_ends(double z) const {
    std::vector<double> ends;
    add_torus_sides(z, ends);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Quadric& f = faces_[i].quadric;
      if (f.bend == Bend::kFlat) {
        add_line(f, z, ends);
        for (std::size_t j = 0; j < faces_.size(); ++j) {
          if (j != i) add_crossings(f, faces_[j].quadric, z, ends);
        }
      } else {
        add_sides(f, z, ends);
      }
    }
    return ends;
  }

  // A plane that the lines lie in.
  void add_line(const Quadric& f, double z, std::vector<double>& ends) const {
    if (std::abs(f.linear.x()) > 1e-12 || !(std::abs(f.linear.y()) > 1e-6)) return;
    ends.push_back(-(f.constant + f.linear.z() * z) / f.linear.y());
  }

  // In the section F = a x^2 + 2 (b y + d) x + (c y^2 + 2 e y + g): no x where the discriminant is
  // negative.
  void add_sides(const Quadric& f, double z, std::vector<double>& ends) const {
    const Mat3& h = f.hessian;
    const double a = 0.5 * h(0, 0), b = 0.5 * h(0, 1), c = 0.5 * h(1, 1);
    const double d = 0.5 * (f.linear.x() + h(0, 2) * z), e = 0.5 * (f.linear.y() + h(1, 2) * z);
    const double g = f.constant + f.linear.z() * z + 0.5 * h(2, 2) * z * z;
    if (std::abs(a) < 1e-12 * h.norm()) {  // a tube along the lines
      for_each_root(c, e, g, [&](double y) { ends.push_back(y); });
      return;
    }
    for_each_root(b * b - a * c, b * d - a * e, d * d - a * g, [&](double y) {
      if (on_surface({-(b * y + d) / a, y, z})) ends.push_back(y);
    });
  }

  // The plane f in the section is a line p + s u; where the other face cuts it.
  void add_crossings(const Quadric& f, const Quadric& other, double z,
                     std::vector<double>& ends) const {
    const double nx = f.linear.x(), ny = f.linear.y(), n2 = nx * nx + ny * ny;
    if (!(n2 > 1e-12)) return;
    const double at = -(f.constant + f.linear.z() * z) / n2;
    const Vec3 p(at * nx, at * ny, z), u(-ny, nx, 0.0);
    for_each_root(0.5 * u.dot(other.hessian * u), 0.5 * u.dot(other.linear + other.hessian * p),
                  other(p), [&](double s) {
                    const Vec3 corner = p + s * u;
                    if (on_surface(corner)) ends.push_back(corner.y());
                  });
  }

  // a t^2 + 2 b t + c = 0.
  template <typename Visit>
  static void for_each_root(double a, double b, double c, Visit&& visit) {
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0.0)) return;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    if (q == 0.0) return;
    visit(c / q);
    if (std::abs(a) > 1e-14 * std::abs(q)) visit(q / a);
  }

  Moments section_at(double z) {
    InterruptScope::poll();
    auto line = [this, z](double y) { return line_at(y, z); };
    const double allowed = kInnerTolerance * scale_ / (box_.max.z() - box_.min.z());
    Integral integral(line, length_, allowed);
    return over(integral, y_ends(z), box_.min.y(), box_.max.y());
  }

  Moments line_at(double y, double z) {
    if ((lines_left_ -= 1.0) < 0.0) throw WorkEnds{};
    csg_line(solid_, Vec3(0.0, y, z), Vec3::UnitX(), spans_);
    Moments sum = Moments::Zero();
    for (const RayInterval& span : spans_) {
      const double a = span.enter, b = span.leave, length = b - a;
      const double first = 0.5 * length * (a + b), second = length / 3.0 * (a * a + a * b + b * b);
      sum += Moments({length, first, length * y, length * z, second, first * y, first * z,
                      length * y * y, length * y * z, length * z * z});
    }
    return sum;
  }

  const Csg& solid_;
  const Aabb box_;
  const double size_;
  double lines_left_;
  double length_ = 0.0, scale_ = 0.0;
  std::vector<MemberFace> faces_;
  std::vector<RayInterval> spans_;
};

// The same from a fixed number of lines, evenly spread in each of 16 directions. The error is five
// standard errors of their mean, or a part that all lines may miss.
VolumeMetrics metrics_by_lattice(const Csg& solid, double work) {
  constexpr int kSets = 16;
  constexpr double kStandardErrors = 5.0, kMissed = 3.0;
  // Powers of 1 / 1.3247..., the root of x^3 = x + 1: the most even two-dimensional lattice.
  constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
  constexpr double kGoldenAngle = 2.399963229728653;
  const auto fraction = [](double x) { return x - std::floor(x); };
  const Aabb box = solid.bounds();
  const Vec3 middle = box.center(), half = box.half_sizes();
  const int lines = std::max(1, static_cast<int>(work / line_work(solid) / kSets));
  std::vector<RayInterval> spans;
  MomentSum all;
  double squares = 0.0;
  for (int set = 0; set < kSets; ++set) {
    const double rise = (set + 0.5) / kSets, across = std::sqrt(1.0 - rise * rise);
    const double angle = set * kGoldenAngle;
    const Mat3 basis = basis_with_z(Vec3(across * std::cos(angle), across * std::sin(angle), rise));
    const Vec3 reach = basis.transpose().cwiseAbs() * half, d = basis.col(2);
    const double area = 4.0 * reach.x() * reach.y() / lines;
    MomentSum sum;
    for (int i = 0; i < lines; ++i) {
      const double u = 2.0 * fraction(rise + (i + 1) * kFirst) - 1.0;
      const double v = 2.0 * fraction(rise + (i + 1) * kSecond) - 1.0;
      const Vec3 p = middle + u * reach.x() * basis.col(0) + v * reach.y() * basis.col(1);
      InterruptScope::poll();
      csg_line(solid, p, d, spans);
      for (const RayInterval& span : spans) {
        const double a = span.enter, b = span.leave, length = b - a;
        const Vec3 x = p + 0.5 * (a + b) * d;
        sum.volume += area * length;
        sum.first += area * length * x;
        sum.second += area * length * (outer(x, x) + length * length / 12.0 * outer(d, d));
      }
    }
    squares += sum.volume * sum.volume;
    all += sum;
  }
  all.volume /= kSets;
  all.first /= kSets;
  all.second /= kSets;
  const double variance = std::max(0.0, squares / kSets - all.volume * all.volume) / (kSets - 1);
  VolumeMetrics m = all.metrics();
  m.volume_error = std::max(kStandardErrors * std::sqrt(variance),
                            kMissed * 8.0 * half.prod() / (lines * kSets));
  m.status = Status::kApproximate;
  return m;
}

}  // namespace

VolumeMetrics csg_metrics_by_lines(const Csg& solid, double most_work) {
  constexpr double kLatticeShare = 0.3;  // of the work, where it was not enough
  const Aabb box = solid.bounds();
  if (!((box.max - box.min).minCoeff() > 0.0)) return {};
  // About the middle of the box: a far origin costs accuracy. A torus lies along the axes: the
  // touching lines are then known beforehand.
  Pose X_CS{Mat3::Identity(), -box.center()};
  for (const Csg::Member& member : solid.members()) {
    if (std::holds_alternative<Torus>(member.shape)) X_CS = member.X_MS;
  }
  const Csg centered = solid.posed(X_CS);
  try {
    const Moments m = LineSum(centered, most_work).all();
    MomentSum sum;
    sum.volume = m[0];
    sum.first = Vec3::from(m.data() + 1);
    sum.second = {m[4], m[5], m[6], m[5], m[7], m[8], m[6], m[8], m[9]};
    return transformed(sum.metrics(), X_CS.inverse());
  } catch (const WorkEnds&) {
    return transformed(metrics_by_lattice(centered, kLatticeShare * most_work), X_CS.inverse());
  }
}

}  // namespace volcontact
