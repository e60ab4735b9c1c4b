// SPDX-License-Identifier: Apache-2.0
#include "core/reference/reference_integral.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "core/reference/common_point.h"

namespace volcontact::test {
namespace {

// 0: V. 1..3: int x. 4..9: int xx xy xz yy yz zz. 10: int n_z dS over A. 11..13: int x n_z dS.
// 14, 15: int n_z^2 dS over A's surface inside B and over B's inside A. 16: of faces that are both.
using Values = Vector<17>;

struct Sample {
  std::uint64_t signature = 0;  // of the faces that bound the overlap; 0: nothing there
  Values values = Values::Zero();
};

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 29);
}

struct Fineness {
  int scan;          // points that look for changes, evenly
  int zooms;         // and on each side of the origin, closer and closer
  double tolerance;  // of V, of each stretch
  double end;        // how closely a change is located, of the range
  long budget;       // lines; when they are spent the search for changes and halving end
};

// Gauss-Kronrod rule of 21 points with its Gauss rule of 10, on [0, 1] under x = s^2 (3 - 2 s):
// square roots at the ends become smooth. [QUADPACK]
struct Rule {
  Rule() {
    constexpr double kNodes[] = {0.0,
                                 0.14887433898163121088482600113,
                                 0.29439286270146019813112660310,
                                 0.43339539412924719079926594317,
                                 0.56275713466860468333900009927,
                                 0.67940956829902440623432736511,
                                 0.78081772658641689706371757835,
                                 0.86506336668898451073209668842,
                                 0.93015749135570822600120718006,
                                 0.97390652851717172007796401208,
                                 0.99565716302580808073552728069};
    constexpr double kWeights[] = {0.14944555400291690566493646839, 0.14773910490133849137484151597,
                                   0.14277593857706008079709427314, 0.13470921731147332592805400177,
                                   0.12349197626206585107795810959, 0.10938715880229764189921059033,
                                   0.09312545458369760553506546508, 0.07503967481091995276704314092,
                                   0.05475589657435199603138130024, 0.03255816230796472747881897246,
                                   0.01169463886737187427806439606};
    constexpr double kGauss[] = {0.29552422471475287017381561919, 0.26926671930999635509122692157,
                                 0.21908636251598204399553493423, 0.14945134915058059314586339696,
                                 0.06667134430868813759356880989};
    for (int i = -10; i <= 10; ++i) {
      const int k = std::abs(i);
      const double s = 0.5 * (1.0 + (i < 0 ? -kNodes[k] : kNodes[k])), slope = 3.0 * s * (1.0 - s);
      at.push_back(s * s * (3.0 - 2.0 * s));
      weight.push_back(slope * kWeights[k]);
      coarse.push_back(k % 2 == 1 ? slope * kGauss[k / 2] : 0.0);
    }
  }
  std::vector<double> at, weight, coarse;
};

const Rule& rule() {
  static const Rule the_rule;
  return the_rule;
}

struct Range {
  double low, high;
};

// Sums f over [-range, range] stretch by stretch of one signature. `f(x, values wanted)` makes a
// Sample. The signature of the result is that of the sequence of stretches. `creeping`: f may miss
// what is small, unless it has just seen the like nearby.
template <typename Function>
class Stretches {
 public:
  Stretches(Function& f, double range, const Fineness& fine, const long& left, bool creeping,
            const Range& likely)
      : f_(f),
        end_(fine.end * range),
        tolerance_(fine.tolerance),
        left_(left),
        creeping_(creeping) {
    std::vector<double> scan;
    for (int i = 0; i <= fine.scan; ++i) scan.push_back(range * (2.0 * i / fine.scan - 1.0));
    for (int i = 0; i < fine.zooms; ++i) {
      // Off the round numbers, on which faces like to lie.
      scan.push_back(0.9437 * range * std::ldexp(1.0, -i));
      scan.push_back(-0.9241 * range * std::ldexp(1.0, -i));
    }
    const double middle = 0.5 * (likely.low + likely.high), half = likely.high - middle;
    if (half > 0.0) {
      for (double k = -2.0; k < 2.01; k += 0.25) scan.push_back(middle + 1.013 * k * half);
    }
    std::sort(scan.begin(), scan.end());
    points_.push_back({scan[0], f_(scan[0], false).signature});
    last_ = scan[0];
    if (points_.back().signature == 0) empty_.push_back(last_);
    for (std::size_t i = 1; i < scan.size(); ++i) advance(scan[i]);
  }

  /// From the first to the last place that is not empty.
  Range seen() const {
    Range range{kInfinity, -kInfinity};
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      if (points_[i].signature == 0) continue;
      range.low = std::min(range.low, points_[i].x);
      range.high = std::max(range.high, points_[i + 1].x);
    }
    return range;
  }

  Sample sum(bool with_values) {
    Sample result;
    pieces_.clear();
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      if (points_[i].signature == 0) continue;
      result.signature = mixed(result.signature, points_[i].signature);
      if (with_values) add_pieces(points_[i].x, points_[i + 1].x, points_[i].signature, 3);
    }
    double volume = 0.0, area = 0.0;
    for (const Piece& piece : pieces_) {
      volume += std::abs(piece.values[0]);
      area += std::abs(piece.values[14]) + std::abs(piece.values[15]);
    }
    // A square root that ends just beyond a stretch is felt inside: halve until it is far.
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Piece piece = pieces_[i];
      const bool rough = piece.doubt > tolerance_ * volume ||
                         piece.area_doubt > kAreaTolerance * tolerance_ * area;
      if (rough && piece.halvings < kHalvings && left_ > 0) {
        const double middle = 0.5 * (piece.from + piece.to);
        pieces_[i].values.setZero();
        pieces_.push_back(integrated(piece.from, middle, piece.halvings + 1));
        pieces_.push_back(integrated(middle, piece.to, piece.halvings + 1));
      }
    }
    for (const Piece& piece : pieces_) result.values += piece.values;
    return result;
  }

 private:
  struct Start {
    double x;
    std::uint64_t signature;  // from here on
  };

  // Appends the changes between the last point looked at and x.
  void advance(double x) {
    std::uint64_t signature = f_(x, false).signature;
    if (creeping_ && points_.back().signature == 0 && signature != 0) {
      // Back over all places that looked empty before the like had been seen nearby.
      Start first = creep(x, last_, signature);
      while (has_reached(last_, first) && empty_.size() > 1) {
        empty_.pop_back();
        last_ = empty_.back();
        first = creep(first.x, last_, first.signature);
      }
      points_.push_back({0.5 * (first.x + std::max(last_, first.x - end_)), first.signature});
      last_ = first.x;
    }
    if (creeping_ && points_.back().signature != 0 && signature == 0) {
      Start end = creep(last_, x, points_.back().signature);
      if (has_reached(x, end)) {
        signature = end.signature;
      } else {
        chain(end.x, end.signature);
        last_ = std::min(x, end.x + end_);
        points_.push_back({0.5 * (end.x + last_), 0});
        empty_.assign(1, last_);
      }
    }
    chain(x, signature);
    if (signature == 0) empty_.push_back(x);
  }

  // Whether a creep came to the end of its way, and that place is not empty after all.
  bool has_reached(double to, Start& here) {
    if (std::abs(to - here.x) > 4.0 * end_ || left_ <= 0) return false;
    const std::uint64_t signature = f_(to, false).signature;
    if (signature != 0) here = {to, signature};
    return signature != 0;
  }

  // The farthest place on the way to `to` that is not empty, in steps that grow where they succeed.
  Start creep(double from, double to, std::uint64_t signature) {
    Start here{from, signature};
    double step = 0.5 * (to - from);
    for (int i = 0; i < 400 && std::abs(step) > end_ && left_ > 0; ++i) {
      const std::uint64_t next = f_(here.x + step, false).signature;
      if (next == 0) {
        step *= 0.4;
      } else {
        here = {here.x + step, next};
        step = std::copysign(std::min(std::abs(1.5 * step), 0.5 * std::abs(to - here.x)), step);
      }
    }
    return here;
  }

  void chain(double x, std::uint64_t signature) {
    for (int changes = 0; points_.back().signature != signature && changes < 12 && left_ > 0;
         ++changes) {
      double low = last_, high = x;
      std::uint64_t next = signature;
      while (high - low > end_) {
        const double middle = 0.5 * (low + high);
        const std::uint64_t here = f_(middle, false).signature;
        if (here == points_.back().signature) {
          low = middle;
        } else {
          high = middle;
          next = here;
        }
      }
      points_.push_back({0.5 * (low + high), next});
      last_ = high;
    }
    last_ = x;
    if (points_.back().signature != signature) points_.push_back({x, signature});
  }

  struct Piece {
    double from, to;
    int halvings;
    Values values;
    double doubt, area_doubt;  // differences of the two rules
  };
  static constexpr double kAreaTolerance = 100.0;  // areas may err more than V, relative
  static constexpr int kHalvings = 12;

  Piece integrated(double from, double to, int halvings) {
    const Rule& r = rule();
    Piece piece{from, to, halvings, Values::Zero(), 0.0, 0.0};
    double coarse = 0.0, coarse_area = 0.0;
    for (std::size_t k = 0; k < r.at.size(); ++k) {
      const Values values = f_(from + (to - from) * r.at[k], true).values;
      piece.values += (to - from) * r.weight[k] * values;
      coarse += (to - from) * r.coarse[k] * values[0];
      coarse_area += (to - from) * r.coarse[k] * values[14];
    }
    piece.doubt = std::abs(coarse - piece.values[0]);
    piece.area_doubt = std::abs(coarse_area - piece.values[14]);
    return piece;
  }

  // A point of another signature shows a change that the scan stepped over: cut there.
  void add_pieces(double from, double to, std::uint64_t signature, int cuts) {
    for (const double part : {0.5, 0.03, 0.97, 0.25, 0.75}) {
      const double x = from + (to - from) * part;
      if (cuts == 0 || left_ <= 0 || (to - from) * 0.03 < 4.0 * end_) break;
      const std::uint64_t inner = f_(x, false).signature;
      if (inner == signature) continue;
      const double left = edge(from + 2.0 * end_, x, signature);
      const double right = edge(to - 2.0 * end_, x, signature);
      add_pieces(from, left, signature, cuts - 1);
      if (inner != 0) add_pieces(left, right, inner, cuts - 1);
      return add_pieces(right, to, signature, cuts - 1);
    }
    pieces_.push_back(integrated(from, to, 0));
  }
  // Where the signature that holds at `from` ends on the way to `to`.
  double edge(double from, double to, std::uint64_t signature) {
    while (std::abs(to - from) > end_) {
      const double middle = 0.5 * (from + to);
      (f_(middle, false).signature == signature ? from : to) = middle;
    }
    return 0.5 * (from + to);
  }

  Function& f_;
  double end_, tolerance_;
  const long& left_;  // lines of the budget
  bool creeping_;
  std::vector<Piece> pieces_;
  std::vector<Start> points_;
  std::vector<double> empty_;  // places that looked so since the last that did not
  double last_;                // the last point looked at
};

// Faces that touch without overlap bound intervals of rounding errors.
constexpr double kNothing = 1e-13;

// Lines along z of the frame in which both solids are given.
class Columns {
 public:
  Columns(const ReferenceSolid& a, const ReferenceSolid& b, double range, const Fineness& fine)
      : a_(a), b_(b), range_(range), fine_(fine), left_(fine.budget) {
    first_of_b_ = a_.number_faces(0);
    b_.number_faces(first_of_b_);
  }

  Values sum() {
    auto section = [this](double u, bool with_values) { return section_at(u, with_values); };
    return Stretches(section, range_, fine_, left_, true, {0.0, 0.0}).sum(true).values;
  }

 private:
  Sample section_at(double u, bool with_values) {
    auto line = [this, u](double v, bool wanted) { return line_at(u, v, wanted); };
    Stretches stretches(line, range_, fine_, left_, false, likely_at(u));
    const Range range = stretches.seen();
    if (range.low < range.high) seen_[u] = range;
    return stretches.sum(with_values);
  }

  // Where sections close by suggest to look: between the two next ones, or on beyond the last two.
  Range likely_at(double u) const {
    if (seen_.empty()) return {0.0, 0.0};
    auto right = seen_.lower_bound(u);
    if (right == seen_.end()) --right;
    auto left = right;
    if (left != seen_.begin()) {
      --left;
    } else if (std::next(right) != seen_.end()) {
      ++right;
    }
    if (left == right || left->first == right->first) return left->second;
    const double s = std::clamp((u - left->first) / (right->first - left->first), -2.0, 3.0);
    const auto along = [s](double a, double b) { return a + s * (b - a); };
    const double low = along(left->second.low, right->second.low);
    const double high = along(left->second.high, right->second.high);
    if (low < high) return {low, high};
    const Range& near = s < 0.5 ? left->second : right->second;
    const double middle = 0.5 * (low + high), half = 0.125 * (near.high - near.low);
    return {middle - half, middle + half};
  }

  Sample line_at(double u, double v, bool with_values) {
    --left_;
    const ReferenceSpans in_a = a_.column(u, v);
    Sample sample;
    if (in_a.size() == 0) return sample;
    const ReferenceSpans spans = both(in_a, b_.column(u, v));
    for (int i = 0; i < spans.size(); ++i) {
      const ReferenceSpan& span = spans[i];
      if (span.leave - span.enter < kNothing * range_) continue;
      sample.signature = mixed(sample.signature, static_cast<std::uint64_t>(span.enter_face + 1));
      sample.signature = mixed(sample.signature, static_cast<std::uint64_t>(span.leave_face + 1));
      if (with_values) add(u, v, span, sample.values);
    }
    return sample;
  }

  void add(double u, double v, const ReferenceSpan& span, Values& sum) {
    const double length = span.leave - span.enter, t = 0.5 * (span.leave + span.enter);
    sum[0] += length;
    sum[1] += length * u;
    sum[2] += length * v;
    sum[3] += length * t;
    sum[4] += length * u * u;
    sum[5] += length * u * v;
    sum[6] += length * u * t;
    sum[7] += length * v * v;
    sum[8] += length * v * t;
    sum[9] += length * (t * t + length * length / 12.0);
    add_end(Vec3(u, v, span.enter), span.enter_face, -1.0, span.enter_shared, sum);
    add_end(Vec3(u, v, span.leave), span.leave_face, 1.0, span.leave_shared, sum);
  }
  void add_end(const Vec3& x, int face, double sign, bool shared, Values& sum) {
    const bool of_a = face < first_of_b_;
    const ReferenceSolid& solid = of_a ? a_ : b_;
    const double slant = std::abs(solid.normal(face, x).z());
    sum[of_a ? 14 : 15] += solid.side(face) * slant;
    if (shared) sum[16] += slant;
    if (!of_a) return;
    sum[10] += sign;
    for (int k = 0; k < 3; ++k) sum[11 + k] += sign * x[k];
  }

  ReferenceSolid a_, b_;
  double range_;
  Fineness fine_;
  long left_;
  int first_of_b_;
  std::map<double, Range> seen_;  // sections that were not empty
};

// One direction, expressed in the axes of the frame F.
struct Direction {
  MomentSum moments;
  double flux = 0.0;                      // int n_k dS
  Vec3 first_flux = Vec3::Zero();         // int x n_k dS
  double area = 0.0, counter_area = 0.0;  // int n_k^2 dS
  double shared_area = 0.0;
};

Direction integrate_along(int axis, const ReferenceSolid& a_F, const ReferenceSolid& b_F,
                          double range, const Fineness& fine) {
  // The axes of the lines' frame L in F, cyclic, so that z of L is the axis.
  Mat3 R_FL =
      Mat3::with_columns(Vec3::Unit((axis + 1) % 3), Vec3::Unit((axis + 2) % 3), Vec3::Unit(axis));
  const Pose X_LF{R_FL.transpose(), Vec3::Zero()};
  const Values sum = Columns(a_F.posed(X_LF), b_F.posed(X_LF), range, fine).sum();
  Direction result;
  result.moments.volume = sum[0];
  result.moments.first = R_FL * Vec3::from(sum.data() + 1);
  Mat3 second = {sum[4], sum[5], sum[6], sum[5], sum[7], sum[8], sum[6], sum[8], sum[9]};
  result.moments.second = R_FL * second * R_FL.transpose();
  result.flux = sum[10];
  result.first_flux = R_FL * Vec3::from(sum.data() + 11);
  result.area = sum[14];
  result.counter_area = sum[15];
  result.shared_area = sum[16];
  return result;
}

Reference integrate(const ReferenceSolid& a_F, const ReferenceSolid& b_F, const Lookout& lookout,
                    const Fineness& fine) {
  MomentSum sum;
  Mat3 flux = Mat3::Zero();  // (i, k): int x_i n_k dS
  double shared_area = 0.0;
  const int directions = lookout.all_axes ? 3 : 1;
  std::vector<MomentSum> moments;
  for (int k = 0; k < directions; ++k) {
    const int axis = (k + 2) % 3;
    const Direction d = integrate_along(axis, a_F, b_F, lookout.half_range, fine);
    moments.push_back(d.moments);
    sum.area_vector[axis] = d.flux;
    sum.area += d.area;
    sum.counter_area += d.counter_area;
    shared_area += d.shared_area;
    flux.col(axis) = d.first_flux;
  }
  // The middle one of the three volumes, and how far the nearer of the others is from it.
  std::sort(moments.begin(), moments.end(),
            [](const MomentSum& a, const MomentSum& b) { return a.volume < b.volume; });
  const MomentSum& chosen = moments[moments.size() / 2];
  sum.volume = chosen.volume;
  sum.first = chosen.first;
  sum.second = chosen.second;
  const double error = directions == 1 ? 0.0
                                       : std::min(chosen.volume - moments[0].volume,
                                                  moments[2].volume - chosen.volume);
  const double worst =
      std::max(chosen.volume - moments.front().volume, moments.back().volume - chosen.volume);
  sum.area_moment = Vec3(flux(1, 2) - flux(2, 1), flux(2, 0) - flux(0, 2), flux(0, 1) - flux(1, 0));
  return {transformed(sum.metrics(), lookout.X_AF), error, worst, shared_area};
}

}  // namespace

namespace {

// `least`: a volume of which a small share may be missing too.
Reference integral_of_terms(const ReferenceSolid& a, const ReferenceSolid& b, const Pose& X_AB,
                            const Lookout& lookout, double least) {
  constexpr double kAgreement = 1e-7;  // of V, between the directions
  const Pose X_FA = lookout.X_AF.inverse();
  const ReferenceSolid a_F = a.posed(X_FA), b_F = b.posed(X_FA * X_AB);
  const bool coarse = lookout.tolerance > 1e-6;
  const Reference quick = integrate(a_F, b_F, lookout,
                                    coarse ? Fineness{10, 10, lookout.tolerance, 1e-8, 200000}
                                           : Fineness{20, 18, lookout.tolerance, 1e-11, 1500000});
  const double volume = std::max(least, quick.metrics.volume);
  if (!lookout.all_axes || quick.volume_error <= kAgreement * volume) return quick;
  const Reference careful = integrate(a_F, b_F, lookout, {40, 22, 1e-9, 1e-12, 3000000});
  return careful.volume_error < quick.volume_error ? careful : quick;
}

// Raw sums in A's frame.
MomentSum sums_of(const VolumeMetrics& m, double sign) {
  MomentSum sum;
  sum.volume = sign * m.volume;
  sum.first = sum.volume * m.centroid;
  sum.second = sign * m.second_moment() + outer(sum.first, m.centroid);
  sum.area_vector = sign * m.area_vector;
  sum.area_moment = sign * m.area_moment;
  sum.area = sign * m.area;
  sum.counter_area = sign * m.counter_area;
  return sum;
}

}  // namespace

Reference reference_integral(const ReferenceSolid& a, const ReferenceSolid& b, const Pose& X_AB,
                             const Lookout& lookout) {
  const std::vector<ReferenceTerm> terms_a = a.terms(), terms_b = b.terms();
  if (terms_a.size() == 1 && terms_b.size() == 1) {
    return integral_of_terms(a, b, X_AB, lookout, 0.0);
  }
  Reference all;
  MomentSum sum;
  double largest = 0.0;
  const Pose X_FA = lookout.X_AF.inverse();
  for (const ReferenceTerm& x : terms_a) {
    for (const ReferenceTerm& y : terms_b) {
      Lookout here = lookout;
      if (!x.solid.has_torus() && !y.solid.has_torus()) {
        Vec3 inside;
        if (!find_common_point(x.solid.posed(X_FA), y.solid.posed(X_FA * X_AB), lookout.half_range,
                               inside)) {
          continue;
        }
        here.X_AF.translation = lookout.X_AF * inside;
      }
      const Reference one = integral_of_terms(x.solid, y.solid, X_AB, here, 0.1 * largest);
      largest = std::max(largest, one.metrics.volume);
      sum += sums_of(one.metrics, x.sign * y.sign);
      all.volume_error += one.volume_error;
      all.worst_error += one.worst_error;
      all.shared_area += one.shared_area;
    }
  }
  all.metrics = sum.metrics();
  // Terms all but cancel where a peg touches its bore: then the solids themselves, where that fits.
  constexpr double kCancelled = 1e-5;
  if (all.volume_error <= kCancelled * all.metrics.volume) return all;
  const Reference direct = integral_of_terms(a, b, X_AB, lookout, 0.0);
  const double apart = std::abs(direct.metrics.volume - all.metrics.volume);
  const bool fits = apart <= direct.volume_error + all.volume_error;
  return fits && direct.volume_error < all.volume_error ? direct : all;
}

}  // namespace volcontact::test
