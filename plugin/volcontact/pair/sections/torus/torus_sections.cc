// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_sections.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "volcontact/base/interrupt.h"
#include "volcontact/pair/quadrature/even_steps.h"
#include "volcontact/pair/quadrature/outer_rule.h"
#include "volcontact/pair/sections/even_turn.h"
#include "volcontact/pair/sections/section_metrics.h"
#include "volcontact/pair/sections/torus/torus_breaks.h"

namespace volcontact {
namespace {

constexpr double kAxial = 1e-2;       // of directions, and of R: a face that holds the axis
constexpr double kLostFace = 1e-5;    // of the area: a face that the sums have missed
constexpr double kWidestAngle = 1.6;  // of an undivided arc [rad]
constexpr double kNarrow = 0.16;      // share of a range: an exit that few half-planes see
constexpr double kSameAngle = 1e-11;  // [rad]
constexpr double kOnAxis = 1e-13;     // of a plane from the axis, per radius; a body may be thin
constexpr double kInPlane = 1e-9;     // per R, and the sine of a slope: a rim of a face
constexpr double kAlongAxis = 1e-8;   // of a plane: the sine of its slope
constexpr double kEndError = 5.0;     // error by its estimate where an arc ends in nothing
constexpr double kByChance = 10.0;    // of an error, by its estimate, that is small by chance
constexpr double kTarget = 1e-2;      // share of the tolerance asked of an arc: kinks may be hidden
constexpr double kGapError = 3.0;     // error of V by the gap on a first look, at most as measured
constexpr double kLeftOver = 1e-3;    // of a surface: so little of the other is told to per cents
constexpr double kHalfwayError = 0.6;  // of even steps, by those halfway between: half
constexpr double kWhole = 0.999;       // share of a solid in the overlap, that is all of it

class TorusSectionsRun {
 public:
  TorusSectionsRun(const Torus& torus, const ConvexView& body, const Pose& X,
                   const InterferenceOptions& options, TorusSectionsScratch& scratch,
                   LinesRegions& regions, TorusSurface surface)
      : torus_(torus),
        body_(body),
        X_(X),
        options_(options),
        s_(scratch),
        regions_(regions),
        surface_(surface) {}

  bool run() {
    set_faces();
    set_sections();
    find_torus_exits(s_.faces, torus_.major_radius(), torus_.minor_radius(), s_.exits);
    find_torus_sites(body_, X_, s_.path, s_.exits, s_.sections, s_.sites);
    if (s_.sites.ranges.empty()) return true;
    find_torus_breaks(s_.faces, torus_.major_radius(), torus_.minor_radius(), s_.breaks, &s_.roots);
    for (const TorusRange& range : s_.sites.ranges) {
      integrate(range);
      if (is_open(std::max(options_.tolerance, outer_rule::kLeastOpen))) return false;
      add_region();
    }
    return true;
  }

 private:
  // The planes that the torus reaches, and the round faces.
  void set_faces() {
    s_.faces.clear();
    FaceWriter writer(s_.faces, X_, Owner::kB);
    body_.write_faces(writer);
    std::erase_if(s_.faces.planes, [&](const PlaneFace& plane) {
      return torus_.support_height(plane.normal) <= plane.offset;
    });
    // A plane that holds the axis is seen edge on: it is moved a little.
    const double least = kOnAxis * torus_.major_radius();
    for (PlaneFace& plane : s_.faces.planes) {
      if (std::abs(plane.normal.z()) < kAlongAxis && std::abs(plane.offset) < least) {
        plane.offset = least;
      }
    }
  }

  struct Arc {
    double from, to;
    bool begins, ends;  // with a section of no size; not both

    // The angle at x in [0, 1] and its derivative: a section that grows from nothing like a power
    // of the angle is smooth in x.
    void at(double x, double& angle, double& speed) const {
      const double width = to - from;
      if (begins) {
        angle = from + width * x * x;
        speed = 2.0 * width * x;
      } else if (ends) {
        angle = to - width * (1.0 - x) * (1.0 - x);
        speed = 2.0 * width * (1.0 - x);
      } else {
        angle = from + width * x;
        speed = width;
      }
    }
  };

  // The breaks within a range, in order, with its ends. A whole turn begins at a break. A break
  // beyond the last column found is the end, known better: a plane across the tube ends a section
  // at once. An exit that equal steps may miss is bounded by breaks as well.
  void set_corners(TorusRange& range) {
    corners_.clear();
    s_.angles.assign(s_.breaks.begin(), s_.breaks.end());
    for (const TorusExit& exit : s_.exits) {
      if (exit.width() > kNarrow * (range.high - range.low)) continue;
      s_.angles.push_back(exit.low);
      s_.angles.push_back(exit.high);
    }
    if (range.whole && !s_.angles.empty()) {
      range.low = s_.angles[0];
      range.high = range.low + 2.0 * kPi;
    }
    for (double angle : s_.angles) {
      const double turned =
          angle - 2.0 * kPi * std::floor((angle - range.low + kSameAngle) / (2.0 * kPi));
      if (turned < range.high + kSameAngle) corners_.push_back(turned);
    }
    std::sort(corners_.begin(), corners_.end());
    if (corners_.empty() || range.whole || corners_.front() > range.full_low + kSameAngle) {
      corners_.insert(corners_.begin(), range.low);
    }
    if (range.whole || corners_.back() < range.full_high - kSameAngle)
      corners_.push_back(range.high);
    corners_.erase(std::unique(corners_.begin(), corners_.end(),
                               [](double a, double b) { return b - a < kSameAngle; }),
                   corners_.end());
    range.low = corners_.front();
    range.high = corners_.back();
  }

  void set_sections() {
    s_.sections.choose_rule(options_.tolerance);
    if (closer_) s_.sections.look_closer();
    s_.sections.set(s_.faces, torus_.major_radius(), torus_.minor_radius());
  }

  void integrate(TorusRange range) {
    if (closer_) {
      closer_ = false;
      set_sections();
    }
    set_corners(range);
    integrate_corners(range);
    open_ *= kGapError;
    const double volume = s_.sections.total().moments[0];
    if (!is_open(options_.tolerance) && !is_by_chance(volume)) return;
    closer_ = true;
    set_sections();
    integrate_corners(range);
    open_ =
        outer_rule::kGapShare * std::max(open_, std::abs(s_.sections.total().moments[0] - volume));
  }

  // Whether the equal steps, that were left for arcs, tell another volume than their error says:
  // one of the two has a small error by chance, and be it the arcs, which are alike where the
  // overlap is symmetric.
  bool is_by_chance(double volume) const {
    const double off = std::abs(volume - even_volume_);
    return even_volume_ > 0.0 && off > kByChance * even_error_ && off > options_.tolerance * volume;
  }

  bool is_open(double tolerance) const {
    return open_ > tolerance * s_.sections.total().moments[0];
  }
  double target() const {
    return (closer_ ? outer_rule::kCloserTarget : 1.0) * kTarget * options_.tolerance;
  }
  int least_divisions() const { return closer_ ? outer_rule::kCloserLeast : 0; }
  int depth() const { return outer_rule::kMaxDepth + (closer_ ? outer_rule::kCloserDepth : 0); }

  void integrate_corners(const TorusRange& range) {
    InterruptScope::poll();
    s_.sections.clear();
    error_ = volume_scale_ = even_volume_ = 0.0;
    const bool done =
        range.whole ? s_.angles.empty() && !closer_ &&
                          integrate_even_turn(s_.sections, s_.path, options_.tolerance, error_)
                    : corners_.size() == 2 && !has_axial_plane() && whole_range(range);
    for (std::size_t i = 0; i + 1 < corners_.size() && !done; ++i) {
      const double from = corners_[i], to = corners_[i + 1];
      const bool begins = (!range.whole && i == 0) || is_root(from);
      const bool ends = (!range.whole && i + 2 == corners_.size()) || is_root(to);
      const int parts =
          std::max(begins && ends ? 2 : 1, static_cast<int>(std::ceil((to - from) / kWidestAngle)));
      for (int k = 0; k < parts; ++k) {
        const Arc arc{from + (to - from) * k / parts, from + (to - from) * (k + 1) / parts,
                      begins && k == 0, ends && k + 1 == parts};
        integrate_arc(arc, 0.0, 1.0, 0);
      }
    }
    open_ = openness();
  }

  // Whether sections grow there like the root of the angle, from next to nothing.
  bool is_root(double angle) const {
    return std::any_of(s_.roots.begin(), s_.roots.end(), [angle](double root) {
      return std::abs(std::remainder(angle - root, 2.0 * kPi)) < kSameAngle;
    });
  }

  // How far from closed the surface is, see SurfaceFlux. A face through the axis is not in the
  // sums.
  double openness() const {
    if (has_axial_plane()) return 0.0;
    const TorusSums& sums = s_.sections.total();
    const SectionFaces& sections = s_.sections.faces().sections;
    const double* m = sums.across_rho;
    SurfaceFlux flux({Vec3::UnitX(), Vec3::UnitY()});
    flux.add({Vec3(sums.vector[0], m[0], m[1]), Vec3(sums.vector[1], m[1], m[2])});
    for (int i = 0; i < sections.active_planes; ++i) {
      flux.add_plane(s_.faces.planes[s_.sections.plane_face(i)].normal, sums.planes[i].sums);
    }
    for (int i = 0; i + 1 < sections.round_count; ++i) {
      flux.add_round(sections.rounds[i], sums.rounds[i].sums);
    }
    const double* v = sums.moments;
    if (!(v[0] > 0.0)) return 0.0;
    const Vec3 middle = Vec3(v[1], v[2], v[3]) / v[0];
    const double spread = (v[4] + v[6] + v[9]) / v[0] - middle.squaredNorm();
    return flux.open(v[0], middle.x(), middle.y(), std::sqrt(std::max(spread, 0.0)));
  }

  // A range without breaks, where openness() can tell whether one was overlooked. At its ends
  // sections mostly grow like an odd power of the root of the angle: then the integrand, as a
  // function of theta, angle = middle - half cos theta, is even and periodic, and equal steps
  // converge fastest. False when they do not.
  bool whole_range(const TorusRange& range) {
    double u[kLanes], v[kLanes], weight[kLanes], section[kLanes];
    const double half = 0.5 * (range.high - range.low), middle = range.low + half;
    const EvenSteps& steps = even_steps();
    for (int i = 0; i < kLanes; ++i) {
      const double angle = middle - half * steps.cos[1][i];
      u[i] = std::cos(angle);
      v[i] = std::sin(angle);
      weight[i] = half * kPi / kLanes * steps.sin[i];
    }
    s_.sections.integrate(s_.path, u, v, weight, section);
    for (int i = 0; i < kLanes; ++i) section[i] *= weight[i];
    double volume;
    error_ = steps.error(section, volume);
    volume_scale_ = volume;
    if (error_ > outer_rule::kTarget * options_.tolerance * volume || closer_) {
      even_error_ = std::exchange(error_, 0.0);
      even_volume_ = volume;
      return false;
    }
    s_.sections.accept_batch();
    const double share = outer_rule::kTarget * options_.tolerance;
    if (s_.faces.rounds.empty() || !steps.may_hide_a_kink(section, share)) return true;
    // The sum over half-planes in the middle between these has the opposite error.
    double between = 0.0;
    for (int i = 0; i < kLanes; ++i) {
      const double theta = kPi * i / kLanes, angle = middle - half * std::cos(theta);
      u[i] = std::cos(angle);
      v[i] = std::sin(angle);
      weight[i] = half * kPi / kLanes * std::sin(theta);
    }
    s_.sections.integrate(s_.path, u, v, weight, section);
    for (int i = 0; i < kLanes; ++i) between += section[i] * weight[i];
    error_ = std::max(error_, kHalfwayError * std::abs(between - volume));
    if (error_ <= options_.tolerance * volume) return true;
    s_.sections.clear();
    even_error_ = std::exchange(error_, 0.0);
    even_volume_ = volume;
    return false;
  }

  // One function, not a copy for each depth inside the other.
  [[gnu::noinline, gnu::noclone]] void integrate_arc(const Arc& arc, double x_from, double x_to,
                                                     int divisions) {
    double u[kLanes], v[kLanes], weight[kLanes], section[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      double angle, speed;
      arc.at(x_from + (x_to - x_from) * OuterRule::kNodes[i], angle, speed);
      u[i] = std::cos(angle);
      v[i] = std::sin(angle);
      weight[i] = OuterRule::kWeights[i] * speed * (x_to - x_from);
    }
    s_.sections.integrate(s_.path, u, v, weight, section);
    double volume = 0.0;
    for (int i = 0; i < kLanes; ++i) volume += section[i] *= weight[i];
    const RuleError errors = legendre_errors(section);
    const double error = (arc.begins || arc.ends ? kEndError : 1.0) * errors.smooth;
    volume_scale_ = std::max(volume_scale_, volume);
    if (divisions < least_divisions() ||
        (error > target() * volume_scale_ && divisions < depth())) {
      const double middle = 0.5 * (x_from + x_to);
      integrate_arc(arc, x_from, middle, divisions + 1);
      integrate_arc(arc, middle, x_to, divisions + 1);
      return;
    }
    error_ += std::max(error, errors.kinked);
    s_.sections.accept_batch();
  }

  void add_region() {
    const TorusSums& sums = s_.sections.total();
    const double* m = sums.moments;
    MomentSum sum;
    sum.volume = m[0];
    sum.first = Vec3(m[1], m[2], m[3]);
    sum.second = {m[4], m[5], m[7], m[5], m[6], m[8], m[7], m[8], m[9]};
    set_surface(sum);
    shorten_vector(sum);
    VolumeMetrics metrics = sum.metrics();
    if (!metrics.touching()) return;
    const double error = std::max(error_, open_);
    metrics.volume_error = error + outer_rule::kInnerError * metrics.volume;
    if (error > options_.tolerance * metrics.volume) metrics.status = Status::kApproximate;
    set_depth(metrics);
    settle_contained(metrics);
    LinesRegion& region = regions_.add();
    region.metrics = metrics;
    add_patches(region.patches);
  }

  bool by_planes() const { return s_.faces.rounds.empty() && surface_ == TorusSurface::kBest; }

  // From the planes of a body that has nothing else, else from the torus.
  void set_surface(MomentSum& sum) const {
    const TorusSums& sums = s_.sections.total();
    const SectionFaces& sections = s_.sections.faces().sections;
    sum.area = sums.area;
    const bool flat = by_planes();
    for (int i = 0; i < sections.active_planes; ++i) {
      const double* x = sums.planes[i].sums;
      sum.counter_area += x[0];
      if (!flat) continue;
      const Vec3& n = s_.faces.planes[s_.sections.plane_face(i)].normal;
      sum.area_vector -= x[0] * n;
      sum.area_moment -= Vec3(x[1], x[2], x[3]).cross(n);
    }
    for (int i = 0; i + 1 < sections.round_count; ++i) sum.counter_area += sums.rounds[i].area;
    const Vec3 of_torus(sums.vector[0], sums.vector[1], sums.vector[2]);
    if (flat) {
      // A face through the axis lies in one half-plane, of which the sums see nothing.
      const double lost = (of_torus - sum.area_vector).norm();
      if (!has_axial_plane() || lost < kLostFace * sum.area) return;
      sum.counter_area += lost;
    }
    sum.area_vector = of_torus;
    sum.area_moment = Vec3(sums.moment[0], sums.moment[1], 0.0);
    if (flat) return;
    const Vec3 of_body = vector_of_body();
    const double lost = (of_torus - of_body).norm();
    if (has_axial_plane() && lost >= kLostFace * sum.area) {
      sum.counter_area += lost;
    } else if (of_torus.norm() > sum.counter_area) {
      // No vector is longer than its area: where the body shows next to none, the body tells it.
      sum.area_vector = of_body;
    }
  }

  // Where a solid is nearly all within the other, the area vector is the rest of a large sum: no
  // longer than what is left of the smaller surface.
  static void shorten_vector(MomentSum& sum) {
    const double least = std::min(sum.area, sum.counter_area), length = sum.area_vector.norm();
    if (!(length > least) || least > kLeftOver * std::max(sum.area, sum.counter_area)) return;
    sum.area_vector *= least / length;
    sum.area_moment *= least / length;
  }

  Vec3 vector_of_body() const {
    const TorusSums& sums = s_.sections.total();
    const SectionFaces& sections = s_.sections.faces().sections;
    Vec3 vector = Vec3::Zero();
    for (int i = 0; i < sections.active_planes; ++i) {
      vector -= sums.planes[i].sums[0] * s_.faces.planes[s_.sections.plane_face(i)].normal;
    }
    for (int i = 0; i + 1 < sections.round_count; ++i) {
      const SectionRound& r = sections.rounds[i];
      const double* x = sums.rounds[i].sums;
      vector -= x[0] * Vec3(r.g) + x[1] * Vec3(r.g_u) + x[2] * Vec3(r.g_v) + x[3] * Vec3(r.g_t);
    }
    return vector;
  }

  bool has_axial_plane() const {
    for (const PlaneFace& plane : s_.faces.planes) {
      if (std::abs(plane.normal.z()) < kAxial &&
          std::abs(plane.offset) < kAxial * torus_.major_radius() && reaches_ring(plane)) {
        return true;
      }
    }
    return false;
  }

  // Not if it ends at a rim that does not: the tip of a cone may lie at the axis, in the hole.
  bool reaches_ring(const PlaneFace& plane) const {
    const double R = torus_.major_radius(), r = torus_.minor_radius();
    return std::none_of(s_.faces.rims.begin(), s_.faces.rims.end(), [&](const Rim& rim) {
      const Vec3& c = rim.center;
      const double radius = rim.radius_u.norm();
      const bool in_plane =
          std::abs(plane.normal.dot(c) - plane.offset) <= kInPlane * R &&
          rim.radius_u.cross(rim.radius_v).cross(plane.normal).norm() <= kInPlane * radius * radius;
      return in_plane && std::hypot(std::hypot(c.x(), c.y()) - R, c.z()) - r > radius;
    });
  }

  // Depth under the planes of a flat body, in proportion to the squares of their area vectors, the
  // largest to those along the normal alone; in other bodies that under the surface of the tube,
  // (r^2 - t^2) / 2 r.
  void set_depth(VolumeMetrics& metrics) const {
    const TorusSums& sums = s_.sections.total();
    const double R = torus_.major_radius(), r = torus_.minor_radius();
    const double* m = sums.moments;
    metrics.depth = r - std::sqrt(std::max(0.0, sums.least_inside));
    metrics.depth_moment =
        ((r * r - R * R) * m[0] + 2.0 * R * sums.radial - m[4] - m[6] - m[9]) / (2.0 * r);
    if (!by_planes()) return;
    const Vec3 normal = metrics.normal();
    double weight = 0.0, moment = 0.0, along = 0.0, depth = 0.0;
    const SectionFaces& sections = s_.sections.faces().sections;
    for (int i = 0; i < sections.active_planes; ++i) {
      const PlaneFace& plane = s_.faces.planes[s_.sections.plane_face(i)];
      const double area = sums.planes[i].sums[0];
      weight += area * area;
      moment += area * area * (plane.offset - plane.normal.dot(metrics.centroid)) * metrics.volume;
      const double pressed = area * std::max(0.0, normal.dot(plane.normal));
      along += pressed * pressed;
      depth += pressed * pressed * (plane.offset + torus_.support_height(-plane.normal));
    }
    if (!(weight > 0.0)) return;
    metrics.depth_moment = moment / weight;
    if (along > 0.0) metrics.depth = depth / along;
  }

  void settle_contained(VolumeMetrics& metrics) const {
    if (metrics.area == 0.0) {
      const VolumeMetrics own = body_.own_metrics();
      if (metrics.volume > kWhole * own.volume) {
        metrics = transformed(own, X_);
        metrics.status = Status::kContained;
      }
    } else if (metrics.counter_area == 0.0) {
      const VolumeMetrics own = torus_.own_metrics();
      if (metrics.volume > kWhole * own.volume) {
        metrics = own;
        metrics.status = Status::kContained;
      }
    }
  }

  void add_patches(std::vector<LinesRegion::PlanePatch>& patches) const {
    const SectionFaces& sections = s_.sections.faces().sections;
    for (int i = 0; i < sections.active_planes; ++i) {
      const PlaneFace& plane = s_.faces.planes[s_.sections.plane_face(i)];
      const double* x = s_.sections.total().planes[i].sums;
      if (!(x[0] > 0.0)) continue;
      patches.push_back(
          {plane.owner, plane.normal, plane.offset, x[0], Vec3(x[1], x[2], x[3]) / x[0]});
    }
  }

  const Torus& torus_;
  const ConvexView& body_;
  const Pose& X_;
  const InterferenceOptions& options_;
  TorusSectionsScratch& s_;
  LinesRegions& regions_;
  TorusSurface surface_;
  std::vector<double>& corners_ = s_.corners;
  double error_ = 0.0, volume_scale_ = 0.0;
  double open_ = 0.0;                            // how far the surface is from closed
  double even_volume_ = 0.0, even_error_ = 0.0;  // by equal steps that were not good enough
  bool closer_ = false;                          // more columns, since with fewer it was not
};

}  // namespace

bool add_torus_regions(const Torus& torus, const ConvexView& body, const Pose& X,
                       const InterferenceOptions& options, TorusSectionsScratch& scratch,
                       LinesRegions& regions, TorusSurface surface) {
  return TorusSectionsRun(torus, body, X, options, scratch, regions, surface).run();
}

bool torus_interference(const Torus& torus, const ConvexView& body, const Pose& X_AB,
                        const InterferenceOptions& options, TorusSectionsScratch& scratch,
                        LinesRegions& regions, Interference& out) {
  out.sites.clear();
  out.total = VolumeMetrics{};
  if (!(torus.own_metrics().volume > 0.0) || !(body.own_metrics().volume > 0.0)) return true;
  regions.cut(0);
  if (!add_torus_regions(torus, body, X_AB, options, scratch, regions)) return false;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const VolumeMetrics& site = regions[i].metrics;
    out.total = i == 0 ? site : out.total + site;
    out.sites.push_back(site);
  }
  return true;
}

}  // namespace volcontact
