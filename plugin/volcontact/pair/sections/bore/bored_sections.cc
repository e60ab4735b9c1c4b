// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/bore/bored_sections.h"

#include <algorithm>

#include "volcontact/base/interrupt.h"
#include "volcontact/pair/quadrature/outer_rule.h"
#include "volcontact/pair/sections/even_turn.h"
#include "volcontact/pair/sections/section_metrics.h"

namespace volcontact {
namespace {

constexpr double kWidestAngle = 1.6;  // of an undivided arc [rad]
constexpr double kSameAngle = 1e-9;
constexpr double kPastEnd = 1e-6;  // of a lobe: there the outline is known to rounding [rad]
constexpr double kGapError = 2.5;  // error of V by the gap on a first look, at most as measured
constexpr double kOnAxis = 1e-8;   // of a plane from the axis, per radius
constexpr double kOnFace = 1e-6;   // of an apex from a face, per its distance from the middle
constexpr double kOnWall = 1e-12;  // of a place from the wall, per the size of the numbers
constexpr double kEndError =
    5.0;  // error by its estimate where an arc ends in nothing, as measured
constexpr double kInnerCone = 1e-4;   // error of the rule along a half-plane, from an apex, per V
constexpr double kLeastLobe = 1e-7;   // of radii: what rounding may leave nothing of
constexpr double kNearWall = 1e-3;    // of a place from the wall, in radii: there may be a film
constexpr double kNearFlank = 1e-5;   // the same of the flank of a cone with its taper
constexpr double kSameTaper = 1e-9;   // of slopes and axes
constexpr double kThroughBore = 0.5;  // of radii: between places outside of the wall nothing is

class BoreRun {
 public:
  BoreRun(const ConvexView& a, const ConvexView& b, const Pose& X_AB, const Bore& bore, Owner owner,
          const InterferenceOptions& options, LinesScratch& lines, BoreScratch& scratch,
          LinesRegions& regions)
      : a_(a),
        b_(b),
        X_AB_(X_AB),
        bore_(bore),
        owner_(owner),
        options_(options),
        s_(lines),
        breaks_(scratch.breaks),
        film_(scratch.film),
        regions_(regions),
        body_(owner == Owner::kA ? b : a, owner == Owner::kA ? X_AB : Pose{}, other(owner), bore,
              scratch.body),
        outline_(bore, body_, window_, lines, scratch.outline) {}

  bool run() {
    if (body_.reach() <= 1.0) return true;  // all of it in the bore
    window_ = find_lines_window(a_, b_, X_AB_, s_.path, true, s_.faces);
    if (window_.kind == LinesWindow::Kind::kApart) return true;
    if (apex_is_on_a_face()) return is_film({});
    s_.sections.choose_rule(options_.tolerance);
    move_off_axis();
    if (bore_.is_cone()) look_straight_ahead();
    if (is_flank_near_wall() && is_film({})) return true;
    if (!outline_.trace()) return false;
    set_rounding();
    const std::vector<Place>& places = outline_.places();
    for (const Place& place : places) {
      if (!std::isfinite(place.rho)) return false;
    }
    const auto [nearest, farthest] = std::minmax_element(
        places.begin(), places.end(), [](const Place& p, const Place& q) { return p.rho < q.rho; });
    const double radius = bore_.radius_at(window_.center);
    // The places are known to what the sections take to be parallel to the wall.
    const bool near_wall = std::abs(farthest->rho - 1.0) < kNearWall;
    if (near_wall &&
        is_wall_film(s_.faces.active, bore_, std::max(farthest->rho - 1.0, 0.0) * radius,
                     extent_along()) &&
        add_film(places)) {
      return true;
    }
    if (!is_outer(*farthest)) return true;  // all of it in the bore
    if (!(nearest->rho < 1.0 - rounding_)) return outside_all_round();
    if (each_lobe()) return true;
    return near_wall && is_film(places);
  }

 private:
  using Place = BoreOutline::Place;

  bool add_film(const std::vector<Place>& places) {
    return add_wall_film({a_, b_, X_AB_, bore_, owner_, s_.faces.active}, window_.center, places,
                         options_, film_, regions_);
  }

  // What is left where sections do not see it, as the flank of a cone that is parallel to the wall:
  // nothing but a film that is known to the tolerance.
  bool is_film(const std::vector<Place>& places) {
    const std::size_t begun = regions_.size();
    bool good = add_film(places) && regions_.size() > begun;
    for (std::size_t i = begun; good && i < regions_.size(); ++i) {
      good = regions_[i].metrics.status == Status::kOk;
    }
    if (!good) regions_.cut(begun);
    return good;
  }

  // Whether a cone of the same taper, its axis parallel, lies along the wall: from the apex it is
  // seen edge on.
  bool is_flank_near_wall() const {
    if (!bore_.is_cone()) return false;
    for (const RoundFace& face : s_.faces.active.rounds) {
      if (!face.cone) continue;
      const Vec3 axis = face.map.row(2);  // as long as the taper
      if (!((axis - bore_.slope * bore_.axis).norm() < kSameTaper * bore_.slope)) continue;
      const double across = bore_.from_axis(face.center).norm();
      const double depth = across - bore_.slope * bore_.height(face.center);
      if (std::abs(depth) < kNearFlank * bore_.radius_at(window_.center)) return true;
    }
    return false;
  }

  // About how far the overlap reaches along the axis.
  double extent_along() const {
    return 2.0 * std::sqrt(5.0) * (window_.spread.transpose() * bore_.axis).norm();
  }

  // Distance from the wall, in radii, below which a place lies on it. There is nothing between a
  // wall and what fits it, and a bore that the overlap touches takes nothing away.
  void set_rounding() {
    const double size = bore_.center.norm() + window_.center.norm() + X_AB_.translation.norm();
    rounding_ = kOnWall * (1.0 + size / bore_.radius_at(window_.center));
  }

  bool is_outer(const Place& place) const { return place.rho > 1.0 + rounding_; }

  // A round face is no function of the direction from a place on it.
  bool apex_is_on_a_face() const {
    if (!bore_.is_cone()) return false;
    for (const RoundFace& face : s_.faces.active.rounds) {
      const Vec3 y = face.map * (bore_.center - face.center);
      const double size = face.level() + y.squaredNorm();
      if (std::abs(face(bore_.center)) < kOnFace * size && !(y.norm() < kOnFace)) return true;
    }
    return false;
  }

  // From the apex the outline is roundest along the axis, where the overlap is there.
  void look_straight_ahead() {
    const Vec3 ahead = bore_.center + bore_.height(window_.center) * bore_.axis;
    const auto within = [&](const RayInterval& span) {
      return span.enter < 0.0 && span.leave > 0.0;
    };
    if (within(a_.ray(Pose{}, ahead, bore_.axis)) && within(b_.ray(X_AB_, ahead, bore_.axis))) {
      window_.center = ahead;
    }
  }

  // A plane that holds the axis is seen edge on from it: it is moved so that the axis lies within.
  void move_off_axis() {
    const double least = kOnAxis * bore_.radius_at(window_.center);
    for (PlaneFace& plane : s_.faces.active.planes) {
      const double beyond = plane.offset - plane.normal.dot(bore_.center);
      if (std::abs(plane.normal.dot(bore_.axis)) < kOnAxis && std::abs(beyond) < least) {
        plane.offset += least - beyond;
      }
    }
  }

  double angle_of(const Vec3& x) const {
    const Vec3 d = bore_.from_axis(x);
    return std::atan2(d.dot(side_v_), d.dot(side_u_));
  }

  // The frame about the axis of the bore for a lobe about the place x: angles count from there.
  void set_bore_frame(const Vec3& x) {
    const Vec3 d = bore_.from_axis(x);
    side_u_ = d.normalized();
    side_v_ = bore_.axis.cross(side_u_);
    frame_.central = bore_.is_cone();
    frame_.t = frame_.central ? Vec3(bore_.axis * bore_.height(x)) : bore_.axis;
    frame_.center = frame_.central ? bore_.center : Vec3(x - d);
    frame_.u = bore_.radius_at(x) * side_u_;
    frame_.v = bore_.radius_at(x) * side_v_;
    s_.faces.active.has_bore = true;
    s_.faces.active.bore = bore_;
    s_.faces.active.wall = face_of(bore_, owner_);
    s_.sections.set(s_.faces.active, s_.faces.idle, frame_);
  }

  // All of the outline lies outside of the bore: the overlap goes round it, or misses it.
  bool outside_all_round() {
    set_bore_frame(outline_.places()[0].point);
    if (has_gap()) return false;
    if (!goes_round_axis()) return add_lines_region(a_, b_, X_AB_, options_, s_, regions_);
    return integrate(-kPi, kPi, false) && !is_lost(kInfinity);
  }

  // Whether the way from one place to the next passes near the axis, though both lie outside of the
  // wall: then there are too few to tell.
  bool has_gap() const {
    const std::vector<Place>& places = outline_.places();
    Vec3 from = bore_.seen(places.back().point);
    for (const Place& place : places) {
      const Vec3 to = bore_.seen(place.point), way = to - from;
      const double square = way.squaredNorm();
      const double part = square > 0.0 ? std::clamp(-from.dot(way) / square, 0.0, 1.0) : 0.0;
      if ((from + part * way).norm() < kThroughBore) return true;
      from = to;
    }
    return false;
  }

  // Whether the axis pierces the outline, a convex curve: then it crosses the ray along -u, in the
  // frame of the bore, once.
  bool goes_round_axis() const {
    const std::vector<Place>& places = outline_.places();
    Vec3 from = bore_.seen(places.back().point);
    int crossings = 0;
    for (const Place& place : places) {
      const Vec3 to = bore_.seen(place.point);
      const double v0 = from.dot(side_v_), v1 = to.dot(side_v_);
      if ((v0 > 0.0) != (v1 > 0.0)) {
        const double u0 = from.dot(side_u_), u1 = to.dot(side_u_);
        if ((u0 * v1 - u1 * v0) * (v1 - v0) < 0.0) ++crossings;
      }
      from = to;
    }
    return crossings % 2 == 1;
  }

  bool each_lobe() {
    const std::size_t n = outline_.places().size();
    std::size_t first = 0;  // an inner place whose next one is outer
    while (first < n &&
           !(!is_outer(outline_.places()[first]) && is_outer(outline_.places()[(first + 1) % n]))) {
      ++first;
    }
    const std::size_t begun = regions_.size();
    for (std::size_t k = 0; k < n;) {
      const Place inner = outline_.places()[(first + k) % n];
      std::size_t last = k + 1;
      Place top = outline_.places()[(first + last) % n];
      while (last < n && is_outer(outline_.places()[(first + last) % n])) {
        const Place& p = outline_.places()[(first + last) % n];
        if (p.rho > top.rho) top = p;
        ++last;
      }
      const bool is_lobe = !is_outer(inner) && last > k + 1;
      if (is_lobe &&
          !add_lobe(inner, top, outline_.places()[(first + last - 1) % n], k + 1, last, first)) {
        regions_.cut(begun);
        return false;
      }
      k = is_lobe ? last : k + 1;
    }
    return true;
  }

  // The places from number `from` to before `to` lie outside of the wall.
  bool add_lobe(const Place& inner, const Place& top, const Place& last_outer, std::size_t from,
                std::size_t to, std::size_t first) {
    const std::size_t n = outline_.places().size();
    const Place outer = outline_.places()[(first + from) % n],
                after = outline_.places()[(first + to) % n];
    Place inner_two[2] = {inner, after}, outer_two[2] = {outer, last_outer}, found[2];
    outline_.crossings(top, inner_two, outer_two, found);
    Place beside[kLanes];
    const Place next_two[2] = {outer, last_outer};
    outline_.between(found, next_two, beside);
    const Place &begin = found[0], &end = found[1];
    set_bore_frame(top.point);
    double low = angle_of(begin.point), high = angle_of(end.point);
    if (low > 0.0) low -= 2.0 * kPi;
    if (high < 0.0) high += 2.0 * kPi;
    if (low > high || high - low > 2.0 * kPi) return false;
    // Past the ends a half-plane would cut the overlap, but not at the wall.
    for (const Place& place : beside) {
      double angle = angle_of(place.point);
      if (angle < low - kPi) angle += 2.0 * kPi;
      if (angle > high + kPi) angle -= 2.0 * kPi;
      const bool within = (angle >= low - kPastEnd && angle <= high + kPastEnd) ||
                          (angle - 2.0 * kPi >= low - kPastEnd) ||
                          (angle + 2.0 * kPi <= high + kPastEnd);
      if (!within) return false;
    }
    for (std::size_t k = from; k < to; ++k) {
      const double angle = angle_of(outline_.places()[(first + k) % n].point);
      const bool within =
          (angle >= low && angle <= high) || angle - 2.0 * kPi >= low || angle + 2.0 * kPi <= high;
      if (!within) return false;
    }
    return integrate(low, high, true) && !is_lost(top.rho - 1.0);
  }

  // Nothing where the outline reaches this far out of the bore, in radii: it was not traced.
  bool is_lost(double out) const {
    return out > kLeastLobe && !(s_.sections.total().moments[0] > 0.0);
  }

  void set_breaks(double low, double high, bool open) {
    const double tolerance = 1e-9 * frame_.u.norm();
    find_breaks(s_.faces.active, frame_, tolerance, s_.breaks);
    breaks_.clear();
    for (const Vec2& d : s_.breaks.directions) {
      const double angle = std::atan2(d.y(), d.x());
      for (double turned : {angle - 2.0 * kPi, angle, angle + 2.0 * kPi}) {
        if (turned > low + kSameAngle && turned < high - kSameAngle) breaks_.push_back(turned);
      }
    }
    if (!open && !breaks_.empty()) {
      // A whole turn begins at a break.
      const double shift = breaks_.front() - low;
      for (double& angle : breaks_) {
        angle -= shift;
        if (angle <= low) angle += 2.0 * kPi;
      }
      turned_by_ = shift;
    }
    breaks_.push_back(low);
    breaks_.push_back(high);
    std::sort(breaks_.begin(), breaks_.end());
    breaks_.erase(std::unique(breaks_.begin(), breaks_.end(),
                              [](double a, double b) { return b - a < kSameAngle; }),
                  breaks_.end());
    if (breaks_.back() < high) breaks_.back() = high;
  }

  // The region between two angles; `open` when it ends there, else it goes all round. Once more,
  // with more columns, where the surface that was found is not closed; false where it is not then.
  bool integrate(double low, double high, bool open) {
    turned_by_ = 0.0;
    set_breaks(low, high, open);
    integrate_arcs(open);
    open_ *= kGapError;
    if (is_open(options_.tolerance)) {
      const double volume = s_.sections.total().moments[0];
      closer_ = true;
      s_.sections.look_closer();
      s_.sections.set(s_.faces.active, s_.faces.idle, frame_);
      integrate_arcs(open);
      open_ = outer_rule::kGapShare *
              std::max(open_, std::abs(s_.sections.total().moments[0] - volume));
      closer_ = false;
      s_.sections.choose_rule(options_.tolerance);
    }
    if (is_open(std::max(options_.tolerance, outer_rule::kLeastOpen))) return false;
    add_region();
    return true;
  }

  bool is_open(double tolerance) const {
    return open_ > tolerance * s_.sections.total().moments[0];
  }
  double target() const {
    return (closer_ ? outer_rule::kCloserTarget : 1.0) * outer_rule::kTarget * options_.tolerance;
  }
  int least_divisions() const { return closer_ ? outer_rule::kCloserLeast : 0; }
  int most_divisions() const {
    return outer_rule::kMaxDepth + (closer_ ? outer_rule::kCloserDepth : 0);
  }

  void integrate_arcs(bool open) {
    InterruptScope::poll();
    s_.sections.clear();
    error_ = 0.0;
    volume_scale_ = 0.0;
    const bool smooth_ring = !open && !closer_ && s_.breaks.complete && breaks_.size() == 2 &&
                             integrate_even_turn(s_.sections, s_.path, options_.tolerance, error_);
    for (std::size_t i = 0; i + 1 < breaks_.size() && !smooth_ring; ++i) {
      const double from = breaks_[i], to = breaks_[i + 1];
      const int parts = std::max(1, static_cast<int>(std::ceil((to - from) / kWidestAngle)));
      for (int k = 0; k < parts; ++k) {
        const Arc arc{from + (to - from) * k / parts, from + (to - from) * (k + 1) / parts,
                      open && i == 0 && k == 0, open && i + 2 == breaks_.size() && k + 1 == parts};
        integrate_arc(arc, 0.0, 1.0, 0);
      }
    }
    open_ = bore_openness(s_.sections, s_.faces.active, frame_);
  }

  struct Arc {
    double from, to;
    bool begins, ends;  // with a section of no size

    // The angle at x in [0, 1] and its derivative: a section that grows from nothing like a power
    // of the angle is smooth in x.
    void at(double x, double& angle, double& speed) const {
      const double width = to - from;
      if (begins && ends) {
        angle = from + 0.5 * width * (1.0 - std::cos(kPi * x));
        speed = 0.5 * width * kPi * std::sin(kPi * x);
      } else if (begins) {
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

  // One function, not a copy for each depth inside the other.
  [[gnu::noinline, gnu::noclone]] void integrate_arc(const Arc& arc, double x_from, double x_to,
                                                     int depth) {
    double u[kLanes], v[kLanes], weight[kLanes], section[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      double angle, speed;
      arc.at(x_from + (x_to - x_from) * OuterRule::kNodes[i], angle, speed);
      u[i] = std::cos(angle + turned_by_);
      v[i] = std::sin(angle + turned_by_);
      weight[i] = OuterRule::kWeights[i] * speed * (x_to - x_from);
    }
    s_.sections.integrate(s_.path, u, v, weight, section);
    double volume = 0.0;
    for (int i = 0; i < kLanes; ++i) volume += section[i] *= weight[i];
    // Near an end the section is no analytic function of x: coefficients fall more slowly.
    const RuleError errors = legendre_errors(section);
    const double error = (arc.begins || arc.ends ? kEndError : 1.0) * errors.smooth;
    volume_scale_ = std::max(volume_scale_, volume);
    if (depth < least_divisions() ||
        (error > target() * volume_scale_ && depth < most_divisions())) {
      const double middle = 0.5 * (x_from + x_to);
      integrate_arc(arc, x_from, middle, depth + 1);
      integrate_arc(arc, middle, x_to, depth + 1);
      return;
    }
    error_ += std::max(error, errors.kinked);
    s_.sections.accept_batch();
  }

  void add_region() {
    const SectionSums& sums = s_.sections.total();
    VolumeMetrics m = moments_of(s_.sections, s_.faces.active, frame_).metrics();
    if (!m.touching()) return;
    // Columns across the wall where this is what pushes, else along the axis.
    const double share = share_of_bore(s_.sections, s_.faces.active, frame_);
    const double across = bore_.wall_normal(side_u_).dot(frame_.u);
    const double length = frame_.t.norm();
    const double low = sums.low.h, high = sums.high.h;
    const double height = frame_.central ? 1.0 / low - 1.0 / high : high - low;
    m.depth_moment = share * across * depth_along_normal(sums.bore, across) +
                     (1.0 - share) * length * sums.depth_moment;
    m.depth = share * across * sums.bore.depth + (1.0 - share) * length * height;
    const double error = std::max(error_, open_);
    m.volume_error = error + (frame_.central ? kInnerCone : s_.sections.inner_error()) * m.volume;
    if (error > options_.tolerance * m.volume) m.status = Status::kApproximate;
    LinesRegion& region = regions_.add();
    region.metrics = transformed(m, Pose{Mat3::Identity(), frame_.center});
    add_patches(s_.sections, s_.faces.active, frame_, region.patches);
  }

  // int depth dV over columns along the normal: those across the wall are shorter by the cosine
  // between the two, 1/c = 1 + (1 - c) to first order. Where the wall goes all round there is no
  // normal.
  double depth_along_normal(const SectionSums::OnBore& on_bore, double across) const {
    const double length = std::hypot(on_bore.x, on_bore.y);
    if (!(length > 0.0)) return on_bore.depth_moment;
    const double along = (on_bore.x * on_bore.depth_x + on_bore.y * on_bore.depth_y) / length;
    const double one_sided = length / on_bore.wall, sideways = across / frame_.u.norm();
    const double share = std::min(1.0, one_sided * one_sided) * sideways * sideways;
    return on_bore.depth_moment + share * (on_bore.depth_moment - along);
  }

  const ConvexView& a_;
  const ConvexView& b_;
  const Pose& X_AB_;
  const Bore& bore_;
  Owner owner_;
  const InterferenceOptions& options_;
  LinesScratch& s_;
  std::vector<double>& breaks_;
  WallFilmScratch& film_;
  LinesRegions& regions_;
  LinesWindow window_;
  BodyInBore body_;
  BoreOutline outline_;
  SectionFrame frame_;
  Vec3 side_u_, side_v_;
  double rounding_ = 0.0;  // of a distance from the axis, in radii
  double turned_by_ = 0.0, error_ = 0.0, volume_scale_ = 0.0;
  double open_ = 0.0;    // how far the surface is from closed
  bool closer_ = false;  // more columns, since with fewer it was not
};

}  // namespace

bool bored_lines(const ConvexView& a, const ConvexView& b, const Pose& X_AB, const Bore& bore,
                 Owner owner, const InterferenceOptions& options, LinesScratch& lines,
                 BoreScratch& scratch, LinesRegions& regions) {
  return BoreRun(a, b, X_AB, bore, owner, options, lines, scratch, regions).run();
}

}  // namespace volcontact
