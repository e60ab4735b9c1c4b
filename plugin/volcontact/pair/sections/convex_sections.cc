// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/convex_sections.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volcontact/pair/quadrature/outer_rule.h"
#include "volcontact/pair/sections/even_turn.h"
#include "volcontact/pair/sections/rim_shape.h"
#include "volcontact/pair/sections/section_metrics.h"
#include "volcontact/pair/sections/unseen_caps.h"

namespace volcontact {
namespace {

constexpr double kClear = 0.02;       // flatness below which S gives no direction to look along
constexpr double kSameCorner = 1e-7;  // squared distance of directions that count as one
constexpr int kMaxRecenterings = 24;  // from a far corner of a thin overlap
constexpr double kRoundRim = 2.0;     // longest by shortest way to the rim; then one step is enough
constexpr double kMostTurn = 0.5;  // of the columns towards the normal of the rim; more: no normal
constexpr double kMostInStrip = 1.3;  // the same where the first direction is known roughly
constexpr double kAligned = 0.1;    // a turn after which the next one would be too small to matter
constexpr double kLeaning = 0.02;   // of the columns to the normal; with more they are turned
constexpr double kSameWay = 1e-12;  // of a normal and the columns along it
constexpr double kAboutUpright = 0.9;  // cosine of columns and a normal that they follow
constexpr double kUpright = 1e-4;      // of a face to the columns: the sine of its lean
constexpr double kWhole = 0.999;       // share of a solid in the overlap, that is all of it
// Of the smaller solid. An overlap of 1e-9 is not to be missed, and from a far corner of a thin one
// the window sees a small part of it.
constexpr double kLeastSeen = 1e-12;
constexpr double kSamePlace = 1e-9;      // of the height of an overlap
constexpr double kRounding = 2e-15;      // of a place, per size
constexpr double kApexRounding = 1e-15;  // of the wall of a cone, per distance of its apex
constexpr int kLeastArcs = 4;            // where no corners are known
constexpr double kWidestAngle = 2.3;     // of an arc between corners [rad]

// The shortest turn of one direction to another that is not opposite.
Mat3 turn_between(const Vec3& from, const Vec3& to) {
  const Vec3 v0 = from.normalized(), v1 = to.normalized(), across = v0.cross(v1);
  const double cosine = v0.dot(v1);
  return cosine * Mat3::Identity() + skew(across) + outer(across / (1.0 + cosine), across);
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

class LinesRun {
 public:
  LinesRun(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
           const InterferenceOptions& options, LinesScratch& scratch)
      : a_(a), b_(b), X_AB_(X_AB), options_(options), s_(scratch) {}

  VolumeMetrics run(bool look_inside) {
    window_ = find_lines_window(a_, b_, X_AB_, s_.path, look_inside, s_.faces);
    switch (window_.kind) {
      case LinesWindow::Kind::kApart:
        return {};
      case LinesWindow::Kind::kAInB:
        return contained(a_.own_metrics());
      case LinesWindow::Kind::kBInA:
        return contained(transformed(b_.own_metrics(), X_AB_));
      case LinesWindow::Kind::kOverlap:
        break;
    }
    choose_frame();
    integrate();
    const VolumeMetrics found = metrics();
    return leans(found) ? upright(found) : found;
  }

  // The surface that was found is not closed, so part of it was overlooked, and so may be a part of
  // the volume.
  bool beyond() const { return is_open(std::max(options_.tolerance, outer_rule::kLeastOpen)); }

  // Nothing where the window saw something: the sections stand on a place from where they do not
  // see.
  bool lost(const VolumeMetrics& metrics, double least_volume) const {
    return window_.kind == LinesWindow::Kind::kOverlap && !metrics.touching() &&
           window_.volume > kLeastSeen * least_volume;
  }

  void add_patches(std::vector<LinesRegion::PlanePatch>& patches) const {
    volcontact::add_patches(s_.sections, s_.faces.active, frame_, patches);
  }

 private:
  static VolumeMetrics contained(VolumeMetrics metrics) {
    metrics.status = Status::kContained;
    return metrics;
  }

  // All of a solid, of which the columns tell the area: it may be a part of a larger one.
  static VolumeMetrics whole(VolumeMetrics own, const VolumeMetrics& by_columns) {
    own.area = by_columns.area;
    own.counter_area = by_columns.counter_area;
    return contained(own);
  }

  bool is_open(double tolerance) const {
    return window_.kind == LinesWindow::Kind::kOverlap &&
           open_ > tolerance * s_.sections.total().moments[0];
  }

  void integrate() {
    target_ = outer_rule::kTarget;
    depth_ = outer_rule::kMaxDepth;
    least_depth_ = 0;
    s_.sections.choose_rule(options_.tolerance);
    s_.sections.set(s_.faces.active, s_.faces.idle, frame_);
    recenter();
    find_breaks(s_.faces.active, frame_, tolerance(), s_.breaks);
    const bool smooth = s_.breaks.complete && s_.breaks.directions.empty();
    if (!smooth || !integrate_smooth()) integrate_arcs();
    if (is_open(options_.tolerance)) look_closer(smooth);
    look_at_unseen();
  }

  // Whether the columns lean so much that depths along them are not those along the normal.
  bool leans(const VolumeMetrics& found) const {
    return found.touching() && found.status != Status::kContained && found.flatness() > kClear &&
           (found.normal() - frame_.t).norm() > kLeaning;
  }

  // Once more, with columns along the normal that was found: what the rim tells of it is not enough
  // of a deep overlap. The depths are those of the second turn; the rest is that of the first one
  // where only this one closes the surface.
  VolumeMetrics upright(VolumeMetrics found) {
    const double open = open_;
    frame_ = round_frame(window_.center, window_.spread, squared(found.normal()));
    along_normal_ = false;
    integrate();
    const VolumeMetrics turned = metrics();
    if (!turned.touching()) return found;
    if (open_ <= open || !is_open(options_.tolerance)) return turned;
    open_ = open;
    found.depth = turned.depth;
    found.depth_moment = turned.depth_moment;
    return found;
  }

  // Once more, with more columns in between.
  void look_closer(bool smooth) {
    s_.sections.look_closer();
    s_.sections.set(s_.faces.active, s_.faces.idle, frame_);
    target_ *= outer_rule::kCloserTarget;
    depth_ += outer_rule::kCloserDepth;
    least_depth_ = outer_rule::kCloserLeast;
    if (!smooth || !integrate_smooth() || is_open(options_.tolerance)) integrate_arcs();
  }

  // Half-planes to caps that none has seen yet.
  void look_at_unseen() {
    if (s_.faces.active.has_bore) return;
    const auto caps = [this](std::vector<Vec2>* directions) {
      return unseen_caps(a_, b_, X_AB_, s_.faces.active, s_.sections, frame_, reach(), directions);
    };
    if (!(caps(&s_.breaks.directions) > 0.0)) return;
    integrate_arcs();
    error_ += caps(nullptr);
  }

  // How far round faces may be from those of the solids, by what they stand for or by the rounding
  // of an apex far away.
  double off_faces() const {
    double most = 0.0;
    for (const RoundFace& face : s_.faces.active.rounds) {
      const double apex = face.cone ? (face.center - frame_.center).norm() : 0.0;
      most = std::max({most, face.off, kApexRounding * apex});
    }
    return most;
  }

  bool is_flat(Owner owner) const { return !s_.faces.active.has_rounds(owner); }

  // Length to which places are known: part of the height of the overlap, but in a thin layer more
  // than that by rounding.
  double tolerance() const {
    const double height = (window_.spread.transpose() * frame_.t).norm();
    return std::max(kSamePlace * height, kRounding * reach());
  }
  // How far from the origins places lie.
  double reach() const {
    return window_.spread.norm() + frame_.center.norm() + X_AB_.translation.norm();
  }

  // The normal of the one plane that a flat solid turns towards the other, from B to A; zero if
  // there is none or more than one.
  Vec3 only_plane() const {
    for (Owner owner : {Owner::kB, Owner::kA}) {
      if (!is_flat(owner)) continue;
      const PlaneFace* only = nullptr;
      int count = 0;
      for (const PlaneFace& plane : s_.faces.active.planes) {
        if (plane.owner != owner) continue;
        only = &plane;
        ++count;
      }
      if (count == 1) return owner == Owner::kB ? only->normal : Vec3(-only->normal);
    }
    return Vec3::Zero();
  }

  // Columns along the contact normal; across them, axes in which the overlap is about round.
  void choose_frame() {
    Vec3 t = only_plane();
    along_normal_ = t.isZero(0.0);
    if (along_normal_) t = -window_.area_vector;
    if (!(t.norm() > 0.0)) t = -X_AB_.translation;
    if (!(t.norm() > 0.0)) t = Vec3::UnitZ();
    t.normalize();
    frame_ = round_frame(window_.center, window_.spread, t);
  }

  // Eight ways to the rim tell its center and its shape, in which it is rounder.
  void recenter() {
    RimShape rim;
    even_directions(kLanes, 0, rim.u, rim.v);
    for (int step = 0; step < kMaxRecenterings; ++step) {
      s_.sections.ends(s_.path, rim.u, rim.v, rim.rho, rim.height);
      const bool aligned = !along_normal_ || align(rim);
      const bool round = rim.longest() < kRoundRim * rim.shortest();
      recenter(rim);
      if (aligned && round && (step > 0 || !window_.strip)) return;
    }
  }

  // Turns the columns to the area vector of the rim, which is that of the faces if these meet
  // there. Whether they were about so before.
  bool align(const RimShape& ends) {
    Vec3 rim[kLanes], sum = Vec3::Zero();
    for (int i = 0; i < kLanes; ++i) {
      rim[i] =
          ends.rho[i] * (ends.u[i] * frame_.u + ends.v[i] * frame_.v) + ends.height[i] * frame_.t;
    }
    for (int i = 0; i < kLanes; ++i) sum += rim[i].cross(rim[(i + 1) % kLanes]);
    sum = squared(sum.normalized());
    const double turn = (sum - frame_.t).norm();
    if (!(turn < (window_.strip ? kMostInStrip : kMostTurn))) return true;
    const Mat3 turned = turn_between(frame_.t, sum);
    frame_.u = turned * frame_.u;
    frame_.v = turned * frame_.v;
    frame_.t = sum;
    return turn < kAligned;
  }

  // The same direction, normal to what is so but for a little: the ends of what lies along the
  // other solid. As steep faces they would have an area of rounding, and the height of a long
  // overlap would be that of its lean.
  Vec3 squared(Vec3 t) const {
    const auto square = [&t](const Vec3& d) {
      const double lean = d.dot(t);
      if (lean != 0.0 && std::abs(lean) < kUpright) t = (t - lean * d).normalized();
    };
    for (const PlaneFace& plane : s_.faces.active.planes) square(plane.normal);
    for (const RoundFace& face : s_.faces.active.rounds) {
      if (!face.cone && face.map.row(2).isZero(0.0)) {
        square(Vec3(face.map.row(0)).cross(Vec3(face.map.row(1))).normalized());
      }
    }
    return t;
  }

  void recenter(const RimShape& rim) {
    SectionFrame frame = frame_;
    double low = 0.0, high = 0.0;
    if (rim.round_off(frame) && column(frame.center, low, high)) {
      frame.center += 0.5 * (low + high) * frame.t;
      frame_ = frame;
    } else {
      rim.go_inwards(frame_);
    }
    s_.sections.set(s_.faces.active, s_.faces.idle, frame_);
  }

  // Without corners the rim is smooth and nearly round: equal steps of the angle converge fastest.
  // False when they do not, as a corner was overlooked.
  bool integrate_smooth() {
    double u[kLanes], v[kLanes], weight[kLanes], section[kLanes];
    EvenTurnValues values;
    std::fill_n(weight, kLanes, kPi / kLanes);
    for (int half = 0; half < 2; ++half) {
      even_directions(2 * kLanes, half, u, v);
      s_.sections.integrate(s_.path, u, v, weight, section);
      s_.sections.accept_batch();
      values.set(2 * kLanes, half, section);
    }
    const RuleError errors = values.errors(2 * kLanes);
    error_ = errors.kinked * s_.sections.total().moments[0];
    measure_opening();
    return errors.smooth <= outer_rule::kEvenTarget * options_.tolerance;
  }

  void integrate_arcs() {
    s_.sections.clear();
    error_ = 0.0;
    volume_scale_ = window_.volume;
    set_corners();
    set_arcs();
    while (!s_.arcs.empty()) integrate_arc();
    measure_opening();
  }
  void measure_opening() {
    open_ = s_.faces.active.has_bore ? 0.0 : openness(s_.sections, s_.faces.active, frame_);
  }

  // The part of the line x + height t inside of both; false when it is empty.
  bool column(const Vec3& x, double& low, double& high) const {
    const RayInterval in_a = a_.ray(Pose{}, x, frame_.t), in_b = b_.ray(X_AB_, x, frame_.t);
    low = std::max(in_a.enter, in_b.enter);
    high = std::min(in_a.leave, in_b.leave);
    return !in_a.empty() && !in_b.empty() && low < high;
  }

  // The breaks in the order of their angle, with more between them where they are far apart.
  void set_corners() {
    std::vector<Vec2>& d = s_.breaks.directions;
    std::sort(d.begin(), d.end(), [](const Vec2& a, const Vec2& b) {
      const bool a_up = a.y() >= 0.0, b_up = b.y() >= 0.0;
      return a_up != b_up ? a_up : a_up ? a.x() > b.x() : a.x() < b.x();
    });
    d.erase(std::unique(d.begin(), d.end(),
                        [](const Vec2& a, const Vec2& b) {
                          return (a - b).squaredNorm() < kSameCorner * kSameCorner;
                        }),
            d.end());
    s_.corners.clear();
    if (d.empty()) d.push_back(Vec2::UnitX());
    for (std::size_t i = 0; i < d.size(); ++i) {
      s_.corners.push_back(d[i]);
      fill(d[i], d[i + 1 < d.size() ? i + 1 : 0], d.size() == 1);
    }
  }

  // Directions between two corners, none inclusive, so that no angle is wide.
  void fill(const Vec2& from, const Vec2& to, bool whole_turn) {
    double angle = std::atan2(cross(from, to), from.dot(to));
    if (whole_turn || angle <= 0.0) angle += 2.0 * kPi;
    const int parts =
        std::max(static_cast<int>(std::ceil(angle / kWidestAngle)), whole_turn ? kLeastArcs : 1);
    for (int k = 1; k < parts; ++k) {
      const double turn = angle * k / parts, c = std::cos(turn), s = std::sin(turn);
      s_.corners.push_back({c * from.x() - s * from.y(), s * from.x() + c * from.y()});
    }
  }

  // Lengthens or shortens each place to the rim.
  void put_on_rim(std::vector<Vec2>& places) {
    double u[kLanes], v[kLanes], rho[kLanes], height[kLanes];
    for (std::size_t from = 0; from < places.size(); from += kLanes) {
      for (std::size_t i = 0; i < kLanes; ++i) {
        const Vec2& p = places[std::min(from + i, places.size() - 1)];
        u[i] = p.x();
        v[i] = p.y();
      }
      s_.sections.ends(s_.path, u, v, rho, height);
      for (std::size_t i = 0; i < kLanes && from + i < places.size(); ++i)
        places[from + i] *= rho[i];
    }
  }

  // From corner to corner, over a place half way between them.
  void set_arcs() {
    const std::size_t n = s_.corners.size();
    for (std::size_t i = 0; i < n; ++i)
      s_.corners.push_back(s_.corners[i] + s_.corners[(i + 1) % n]);
    put_on_rim(s_.corners);
    s_.arcs.clear();
    for (std::size_t i = 0; i < n; ++i) {
      s_.arcs.push_back({s_.corners[i], s_.corners[n + i], s_.corners[(i + 1) % n], 0});
    }
  }

  // Eight half-planes over the arc. Along it, rho of the end is about 1: little is left to resolve.
  void integrate_arc() {
    const LinesScratch::Arc arc = s_.arcs.back();
    s_.arcs.pop_back();
    double u[kLanes], v[kLanes], weight[kLanes], section[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      const double x = OuterRule::kNodes[i];
      const Vec2 place = (1.0 - x) * (1.0 - 2.0 * x) * arc.from +
                         4.0 * x * (1.0 - x) * arc.through + x * (2.0 * x - 1.0) * arc.to;
      const Vec2 along =
          (4.0 * x - 3.0) * arc.from + (4.0 - 8.0 * x) * arc.through + (4.0 * x - 1.0) * arc.to;
      u[i] = place.x();
      v[i] = place.y();
      weight[i] = OuterRule::kWeights[i] * cross(place, along);
    }
    s_.sections.integrate(s_.path, u, v, weight, section);
    for (int i = 0; i < kLanes; ++i) section[i] *= weight[i];
    const RuleError error = legendre_errors(section);
    double volume = 0.0;
    for (double part : section) volume += part;
    volume_scale_ = std::max(volume_scale_, volume);
    if (arc.depth < least_depth_ ||
        (error.smooth > target_ * options_.tolerance * volume_scale_ && arc.depth < depth_)) {
      divide(arc);
      return;
    }
    error_ += error.kinked;
    s_.sections.accept_batch();
  }

  void divide(const LinesScratch::Arc& arc) {
    double u[kLanes], v[kLanes], rho[kLanes], height[kLanes];
    const Vec2 middles[2] = {0.5 * (arc.from + arc.through), 0.5 * (arc.through + arc.to)};
    for (int i = 0; i < kLanes; ++i) {
      u[i] = middles[i / 4].x();
      v[i] = middles[i / 4].y();
    }
    s_.sections.ends(s_.path, u, v, rho, height);
    s_.arcs.push_back({arc.from, middles[0] * rho[0], arc.through, arc.depth + 1});
    s_.arcs.push_back({arc.through, middles[1] * rho[4], arc.to, arc.depth + 1});
  }

  // The extent along n, which is about t, over places of which some are about the farthest.
  double extent(const Vec3& n) const {
    if ((n - frame_.t).norm() > kSameWay) {
      find_tops(s_.faces.active, frame_, n, tolerance(), s_.breaks);
    }
    const SectionSums& sums = s_.sections.total();
    const auto at = [&](const SectionSums::Place& p) {
      return n.dot(p.x * frame_.u + p.y * frame_.v + p.h * frame_.t);
    };
    double low = std::min(at(sums.low), at(sums.high)),
           high = std::max(at(sums.low), at(sums.high));
    for (const Vec3& place : s_.breaks.places) {
      low = std::min(low, n.dot(place));
      high = std::max(high, n.dot(place));
    }
    return high - low;
  }

  VolumeMetrics metrics() const {
    const SectionSums& sums = s_.sections.total();
    VolumeMetrics result = moments_of(s_.sections, s_.faces.active, frame_).metrics();
    if (!result.touching()) return result;
    if (result.area == 0.0) {
      const VolumeMetrics own = b_.own_metrics();
      if (result.volume > kWhole * own.volume) return whole(transformed(own, X_AB_), result);
    }
    if (result.counter_area == 0.0) {
      const VolumeMetrics own = a_.own_metrics();
      if (result.volume > kWhole * own.volume) return whole(own, result);
    }
    result.depth_moment = sums.depth_moment;
    const Vec3 n = result.normal();
    result.depth = extent(n.dot(frame_.t) > kAboutUpright ? squared(n) : frame_.t);
    // Of the pose, and of places that are worked out from it.
    const double rounding = (std::numeric_limits<double>::epsilon() * reach() + off_faces()) *
                            std::max(result.area, result.counter_area);
    const double error = std::max(error_, open_) + rounding;
    result.volume_error = error + s_.sections.inner_error() * result.volume;
    if (error > options_.tolerance * result.volume) result.status = Status::kApproximate;
    return transformed(result, Pose{Mat3::Identity(), frame_.center});
  }

  const ConvexView& a_;
  const ConvexView& b_;
  const Pose& X_AB_;
  const InterferenceOptions& options_;
  LinesScratch& s_;
  LinesWindow window_;
  SectionFrame frame_;
  bool along_normal_ = false;  // the columns are to follow the normal, which is yet to be found
  double error_ = 0.0;
  double open_ = 0.0;                // how far the surface is from closed
  double target_ = 0.0;              // of an arc, per tolerance
  int depth_ = 0, least_depth_ = 0;  // how often an arc is halved, at most and at least
  double volume_scale_ = 0.0;        // least V, as known so far
};

}  // namespace

bool lines_interference(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                        const InterferenceOptions& options, LinesScratch& scratch,
                        Interference& out) {
  out.sites.clear();
  out.total = VolumeMetrics{};
  if (!X_AB.is_finite()) {
    out.total.status = Status::kInvalid;
    return true;
  }
  const double volume_a = a.own_metrics().volume, volume_b = b.own_metrics().volume;
  if (std::isinf(volume_a) && std::isinf(volume_b)) {
    out.total.status = Status::kUnbounded;
    return true;
  }
  if (!(volume_a > 0.0) || !(volume_b > 0.0)) return true;
  LinesRun run(a, b, X_AB, options, scratch);
  out.total = run.run(false);
  if (run.lost(out.total, std::min(volume_a, volume_b))) return false;
  if (run.beyond()) {
    out.total = VolumeMetrics{};
    return false;
  }
  if (out.total.touching()) out.sites.push_back(out.total);
  return true;
}

bool add_lines_region(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                      const InterferenceOptions& options, LinesScratch& scratch,
                      LinesRegions& regions) {
  LinesRun run(a, b, X_AB, options, scratch);
  const VolumeMetrics metrics = run.run(true);
  if (run.beyond()) return false;
  if (!metrics.touching()) {
    return !run.lost(metrics, std::min(a.own_metrics().volume, b.own_metrics().volume));
  }
  LinesRegion& region = regions.add();
  region.metrics = metrics;
  run.add_patches(region.patches);
  return true;
}

}  // namespace volcontact
