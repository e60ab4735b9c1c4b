// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/bore/wall_film.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/quadrature/gauss.h"

namespace volcontact {
namespace {

constexpr double kNothing = 1e-7;        // of the radius: a film that thin is one in any case
constexpr double kLeastLean = 1e-15;     // less is parallel
constexpr double kTinyLean = 5e-8;       // taken to be parallel by the sections
constexpr double kSmallLean = 1e-6;      // of which heights are mostly rounding
constexpr double kTinyLeanFilm = 100.0;  // depth of a film by what the face leans, at most
constexpr double kSmallLeanFilm = 10.0;  // the same of the larger lean
constexpr double kFits = 0.9;            // radius of a peg that fits, by that of the bore
constexpr double kRounding = 8e-16;      // of a thickness, per the size of the numbers
constexpr double kKnown = 100.0;         // of a thickness, by its rounding
constexpr double kThick = 1e-2;          // thickness of a film by its width, at most
constexpr double kWithin = 4e-6;         // of the radius: a line this far within the wall
constexpr int kTurn = 64;                // places all round
constexpr int kHalvings = 44;            // of an angle, to the end of a film
constexpr int kGolden = 40;              // steps to the largest thickness along the wall
constexpr int kRootSteps = 40;           // to the end of a film along the wall
constexpr int kDipSteps = 30;            // to where it is thinnest between two places
constexpr double kDip = 0.25;            // of the largest thickness: there may be a kink
constexpr double kParted = 1e-3;         // the same, where next to nothing holds it together
constexpr int kMostParts = 8;            // halvings of an arc
constexpr int kMostAlong = 6;            // halvings along the wall
constexpr double kTarget = 2e-5;         // of the sums: no more halvings
constexpr double kAreaTarget = 2e-4;     // the same of areas

using Rule = GaussRule<8>;

// Sums over a part of the wall.
struct FilmSum {
  MomentSum moments;  // area: of the wall
  double depth_moment = 0.0, depth = 0.0;

  void add(const FilmSum& other) {
    moments += other.moments;
    depth_moment += other.depth_moment;
    depth = std::max(depth, other.depth);
  }
};

class WallFilm {
  using Dip = WallFilmScratch::Dip;

 public:
  WallFilm(const BoredBodies& bodies, const Vec3& middle, double tolerance,
           WallFilmScratch& scratch)
      : s_(bodies),
        bore_(bodies.bore),
        tolerance_(tolerance),
        angles_(scratch.angles),
        depth_(scratch.depths),
        dips_(scratch.dips) {
    angles_.clear();
    depth_.clear();
    dips_.clear();
    const Mat3 basis = basis_with_z(bore_.axis);
    u_ = basis.col(0);
    v_ = basis.col(1);
    origin_ = bore_.center;
    const double size = bore_.center.norm() + middle.norm() + bodies.X_AB.translation.norm() +
                        radius(height(middle));
    rounding_ = kRounding * size;
  }

  bool run(const std::vector<BoreOutline::Place>& places, LinesRegions& regions) {
    set_angles(places);
    const std::size_t n = angles_.size();
    std::size_t filled = 0;
    for (std::size_t i = 0; i < n; ++i) filled += depth_[i] > rounding_ ? 1 : 0;
    if (filled == 0) return true;
    const std::size_t begun = regions.size();
    if (filled == n) {
      set_dips(0, n);
      const double from = dips_.empty() ? angles_[0] : dips_.front().angle;
      return add_parts(from, from + 2.0 * kPi, regions) || undo(begun, regions);
    }
    for (std::size_t i = 0; i < n; ++i) {
      // From a place without a film to the next one without.
      if (depth_[i] > rounding_ || !(depth_[(i + 1) % n] > rounding_)) continue;
      std::size_t last = i + 1;
      while (depth_[last % n] > rounding_) ++last;
      const double from = end_between(angle(i), angle(i + 1)),
                   to = end_between(angle(last), angle(last - 1));
      set_dips(i + 1, last);
      if (!add_parts(from, to, regions)) return undo(begun, regions);
    }
    return true;
  }

 private:
  static bool undo(std::size_t begun, LinesRegions& regions) {
    regions.cut(begun);
    return false;
  }

  double height(const Vec3& x) const { return bore_.axis.dot(x - origin_); }
  double radius(double h) const { return bore_.is_cone() ? bore_.slope * h : bore_.radius; }
  Vec3 out(double theta) const { return std::cos(theta) * u_ + std::sin(theta) * v_; }
  double angle(std::size_t i) const {
    const std::size_t n = angles_.size();
    return angles_[i % n] + (i >= n ? 2.0 * kPi : 0.0);
  }

  RayInterval within(const Vec3& p, const Vec3& d) const {
    const RayInterval a = s_.a.ray(Pose{}, p, d), b = s_.b.ray(s_.X_AB, p, d);
    return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
  }

  // Thickness across the axis over the wall; negative where nothing is.
  double thickness(const Vec3& e, double h) const {
    const double r = radius(h);
    const RayInterval span = within(origin_ + h * bore_.axis + r * e, e);
    if (!(span.enter < span.leave)) return -r;
    return span.enter > 0.0 ? -span.enter : span.leave;
  }

  // Along the wall in one direction from the axis the thickness is concave.
  struct Strip {
    double low = 0.0, high = 0.0;  // where the film begins and ends
    double depth = -kInfinity;     // its largest thickness
    bool empty() const { return !(low < high); }
  };
  Strip strip_at(double theta) const {
    const Vec3 e = out(theta);
    Strip strip;
    const RayInterval line = bore_.is_cone()
                                 ? within(origin_, bore_.axis + (1.0 - kWithin) * bore_.slope * e)
                                 : within(origin_ + (1.0 - kWithin) * bore_.radius * e, bore_.axis);
    double low = bore_.is_cone() ? std::max(line.enter, 0.0) : line.enter, high = line.leave;
    if (!(low < high) || !std::isfinite(low) || !std::isfinite(high)) return strip;
    const double from = low, to = high;
    const double inner = 1e-9 * (to - from);  // the ends themselves are rounding
    const double at_from = thickness(e, from + inner), at_to = thickness(e, to - inner);
    // Golden section.
    constexpr double kPart = 0.38196601125010515;
    double x = low + kPart * (high - low), y = high - kPart * (high - low);
    double at_low = at_from, at_x = thickness(e, x), at_y = thickness(e, y), at_high = at_to;
    for (int step = 0; step < kGolden; ++step) {
      const double most = std::max(at_x, at_y), slope = std::abs(at_y - at_x) / (y - x);
      if (most > rounding_ && step > 3) break;
      // Nowhere above the line through two places beyond these, so neither between two others.
      const double beyond = most + slope * std::max(x - low, high - y);
      const double between = std::min(at_x + std::max(at_x - at_low, 0.0) * (y - x) / (x - low),
                                      at_y + std::max(at_y - at_high, 0.0) * (y - x) / (high - y));
      if (std::max(beyond, between) < 0.0) return strip;
      if (at_x > at_y) {
        high = y;
        at_high = at_y;
        y = x;
        at_y = at_x;
        x = low + kPart * (high - low);
        at_x = thickness(e, x);
      } else {
        low = x;
        at_low = at_x;
        x = y;
        at_x = at_y;
        y = high - kPart * (high - low);
        at_y = thickness(e, y);
      }
    }
    const double top = at_x > at_y ? x : y, at_top = std::max(at_x, at_y);
    strip.depth = std::max({at_top, at_from, at_to});
    if (!(strip.depth > rounding_)) return strip;
    const double peak = at_top >= std::max(at_from, at_to) ? top
                        : at_from > at_to                  ? from + inner
                                                           : to - inner;
    strip.low = at_from > 0.0 ? from : root(e, from + inner, at_from, peak, strip.depth);
    strip.high = at_to > 0.0 ? to : root(e, to - inner, at_to, peak, strip.depth);
    return strip;
  }

  // Where the thickness vanishes between a place without and one with a film. Illinois.
  double root(const Vec3& e, double out_at, double f_out, double in_at, double f_in) const {
    double x = in_at;
    for (int step = 0; step < kRootSteps; ++step) {
      x = (out_at * f_in - in_at * f_out) / (f_in - f_out);
      const double f = thickness(e, x);
      if (std::abs(f) <= 0.1 * rounding_ || std::abs(out_at - in_at) < 1e-13 * std::abs(x)) break;
      if (f > 0.0) {
        in_at = x;
        f_in = f;
        f_out *= 0.5;
      } else {
        out_at = x;
        f_out = f;
        f_in *= 0.5;
      }
    }
    return x;
  }

  // Even steps, the places of the outline, and where a round face comes nearest to the wall, if its
  // axis is parallel to that of the bore, or it is a ball.
  void set_angles(const std::vector<BoreOutline::Place>& places) {
    for (int i = 0; i < kTurn; ++i) angles_.push_back(2.0 * kPi * (i + 0.5) / kTurn);
    const auto add = [&](const Vec3& x) {
      const Vec3 d = bore_.from_axis(x);
      const double theta = std::atan2(d.dot(v_), d.dot(u_));
      angles_.push_back(theta < 0.0 ? theta + 2.0 * kPi : theta);
    };
    for (const BoreOutline::Place& place : places) add(place.point);
    for (const RoundFace& face : s_.faces.rounds) add(face.center);
    std::sort(angles_.begin(), angles_.end());
    for (const double theta : angles_) depth_.push_back(strip_at(theta).depth);
  }

  // The end of a film between an angle without and one with it.
  double end_between(double without, double with) const {
    for (int step = 0; step < kHalvings; ++step) {
      const double middle = 0.5 * (without + with);
      (strip_at(middle).depth > rounding_ ? with : without) = middle;
    }
    return with;
  }

  // Where the film is thinnest between places of number `from` to before `to`: as where it changes
  // from one end of the wall to the other.
  void set_dips(std::size_t from, std::size_t to) {
    dips_.clear();
    const std::size_t n = angles_.size();
    double most = 0.0;
    for (std::size_t i = from; i < to; ++i) most = std::max(most, depth_[i % n]);
    for (std::size_t i = from; i < to; ++i) {
      const double here = depth_[i % n], before = depth_[(i + n - 1) % n],
                   after = depth_[(i + 1) % n];
      if (here > before || here > after || here > kDip * most) continue;
      double low = angle(i) - 2.0 * kPi / kTurn, high = angle(i) + 2.0 * kPi / kTurn;
      for (int step = 0; step < kDipSteps; ++step) {
        const double third = (high - low) / 3.0;
        if (strip_at(low + third).depth < strip_at(high - third).depth) {
          high -= third;
        } else {
          low += third;
        }
      }
      const double theta = 0.5 * (low + high);
      dips_.push_back({theta, strip_at(theta).depth < kParted * most});
    }
  }

  // Whether a film is not but rounding, of which no halving finds more.
  bool is_known(double depth) const { return depth > kKnown * rounding_; }

  // The film at (theta, h), times a weight of dtheta dh.
  void add_column(const Vec3& e, double h, double weight, FilmSum& sum) const {
    const double d = std::max(0.0, thickness(e, h)), r = radius(h);
    const Vec3 foot = origin_ + h * bore_.axis + r * e, x = foot + 0.5 * d * e;
    const double dv = weight * d * (r + 0.5 * d), slant = std::hypot(1.0, bore_.slope);
    MomentSum& m = sum.moments;
    m.volume += dv;
    m.first += dv * x;
    m.second += outer(dv * x, x);
    // Of A, outward: the wall looks to the axis.
    const double sign = s_.owner == Owner::kA ? -1.0 : 1.0;
    const Vec3 n_dA = sign * weight * r * (e - bore_.slope * bore_.axis);
    m.area_vector += n_dA;
    m.area_moment += foot.cross(n_dA);
    m.area += weight * r * slant;
    const double across = d / slant;
    sum.depth_moment += 0.5 * across * across * weight * r * slant;
    sum.depth = std::max(sum.depth, across);
  }

  // From one end of a film to the other, in x of [0, 1], which is close where the film may fall to
  // nothing: as the root of the way, or over a ball's width at the end of a tube.
  struct Arc {
    double from, to;  // angles, or heights
    double at(double x, double& speed) const {
      const double half = 0.5 * (to - from);
      speed = half * kPi * std::sin(kPi * x);
      return from + half * (1.0 - std::cos(kPi * x));
    }
  };
  FilmSum along(const Vec3& e, const Arc& wall, double x_from, double x_to, double weight) const {
    FilmSum sum;
    for (int i = 0; i < kLanes; ++i) {
      double speed;
      const double h = wall.at(x_from + (x_to - x_from) * Rule::kNodes[i], speed);
      add_column(e, h, weight * speed * (x_to - x_from) * Rule::kWeights[i], sum);
    }
    return sum;
  }
  FilmSum along(const Vec3& e, const Arc& wall, double x_from, double x_to, double weight,
                const FilmSum& whole, int halvings) const {
    const double middle = 0.5 * (x_from + x_to);
    FilmSum one = along(e, wall, x_from, middle, weight),
            two = along(e, wall, middle, x_to, weight);
    const double volume = one.moments.volume + two.moments.volume;
    if (halvings < kMostAlong && is_known(std::max(one.depth, two.depth)) &&
        std::abs(volume - whole.moments.volume) > 0.1 * kTarget * volume) {
      one = along(e, wall, x_from, middle, weight, one, halvings + 1);
      two = along(e, wall, middle, x_to, weight, two, halvings + 1);
    }
    one.add(two);
    return one;
  }

  FilmSum part_of(const Arc& arc, double x_from, double x_to) {
    FilmSum sum;
    for (int i = 0; i < kLanes; ++i) {
      double speed;
      const double theta = arc.at(x_from + (x_to - x_from) * Rule::kNodes[i], speed);
      const Strip strip = strip_at(theta);
      if (strip.empty()) continue;
      const Vec3 e = out(theta);
      const double weight = speed * (x_to - x_from) * Rule::kWeights[i];
      const Arc wall{strip.low, strip.high};
      sum.add(along(e, wall, 0.0, 1.0, weight, along(e, wall, 0.0, 1.0, weight), 0));
      longest_ = std::max(longest_, strip.high - strip.low);
    }
    return sum;
  }
  FilmSum integrate(const Arc& arc, double x_from, double x_to, const FilmSum& whole,
                    int halvings) {
    const double middle = 0.5 * (x_from + x_to);
    FilmSum one = part_of(arc, x_from, middle), two = part_of(arc, middle, x_to), sum = one;
    sum.add(two);
    const MomentSum &m = sum.moments, &w = whole.moments;
    scale_volume_ = std::max(scale_volume_, m.volume);
    scale_area_ = std::max(scale_area_, m.area);
    const double off = std::abs(m.volume - w.volume);
    if (halvings < kMostParts && is_known(sum.depth) &&
        (off > kTarget * scale_volume_ || std::abs(m.area - w.area) > kAreaTarget * scale_area_)) {
      sum = integrate(arc, x_from, middle, one, halvings + 1);
      sum.add(integrate(arc, middle, x_to, two, halvings + 1));
      return sum;
    }
    error_ += off;
    return sum;
  }

  // The film between two angles. False where it is none.
  bool add_parts(double from, double to, LinesRegions& regions) {
    FilmSum sum;
    double begin = from;
    error_ = scale_volume_ = scale_area_ = longest_ = 0.0;
    dips_.push_back({to, true});
    for (const Dip& dip : dips_) {
      if (!(dip.angle > begin)) continue;
      const Arc arc{begin, dip.angle};
      sum.add(integrate(arc, 0.0, 1.0, part_of(arc, 0.0, 1.0), 0));
      begin = dip.angle;
      if (!dip.parts) continue;
      if (!add_region(sum, regions)) return false;
      sum = FilmSum{};
      error_ = scale_volume_ = scale_area_ = longest_ = 0.0;
    }
    return true;
  }

  bool add_region(FilmSum& sum, LinesRegions& regions) const {
    MomentSum& moments = sum.moments;
    if (!(moments.volume > 0.0)) return true;
    const double width = std::min(longest_, moments.area / longest_);
    if (!(sum.depth < kThick * width)) return false;
    moments.counter_area = moments.area;
    VolumeMetrics m = moments.metrics();
    m.depth_moment = sum.depth_moment;
    m.depth = sum.depth;
    m.volume_error = error_ + rounding_ * m.area + (kTarget + sum.depth / width) * m.volume;
    if (m.volume_error > tolerance_ * m.volume) m.status = Status::kApproximate;
    regions.add().metrics = m;
    return true;
  }

  const BoredBodies& s_;
  const Bore& bore_;
  const double tolerance_;
  Vec3 u_, v_, origin_;
  double rounding_;
  std::vector<double>&angles_, &depth_;
  std::vector<Dip>& dips_;
  double error_ = 0.0, scale_volume_ = 0.0, scale_area_ = 0.0, longest_ = 0.0;
};

}  // namespace

bool is_wall_film(const FaceSet& faces, const Bore& bore, double depth, double length) {
  if (depth < kNothing * (bore.radius + bore.slope * length)) return true;
  if (bore.is_cone()) return false;
  for (const RoundFace& face : faces.rounds) {
    if (face.cone) continue;
    // Of a tube; of other faces this is about 1.
    const double lean = (face.map * bore.axis).norm() / face.map.row(0).norm();
    if (lean < kLeastLean || lean > kSmallLean) continue;
    if (lean > kTinyLean && 1.0 > kFits * bore.radius * face.map.row(0).norm()) continue;
    if (depth < (lean < kTinyLean ? kTinyLeanFilm : kSmallLeanFilm) * lean * length) return true;
  }
  return false;
}

bool add_wall_film(const BoredBodies& bodies, const Vec3& middle,
                   const std::vector<BoreOutline::Place>& places,
                   const InterferenceOptions& options, WallFilmScratch& scratch,
                   LinesRegions& regions) {
  return WallFilm(bodies, middle, options.tolerance, scratch).run(places, regions);
}

}  // namespace volcontact
