// SPDX-License-Identifier: Apache-2.0
#include "core/search/pair_search.h"

#include <algorithm>
#include <cstring>
#include <ctime>

#include "core/reference/line_oracle.h"

namespace volcontact::test {
namespace {

constexpr double kRounding = 1e-12;   // of the smaller solid: what counts as no volume
constexpr double kSiteSum = 1e-9;     // of V
constexpr double kSliver = 1e-9;      // of the smaller solid: below it moments are not compared
constexpr double kCentroid = 5e-3;    // of the radius of gyration, beside the claimed error
constexpr double kLeastShare = 0.02;  // of the lines that must meet an overlap for its moments
constexpr double kAreaVector = 1e-2;  // of the larger area, where no faces are shared
constexpr double kIncrement = 2e-2;   // of an increment of V
constexpr double kWrong = 1e-3;       // of V, beyond the claimed error: a wrong number
constexpr double kSlow = 2.0;         // [s]
constexpr double kMotions = 0.1;      // share of the cases that are moved
constexpr int kCloser = 2;            // level of the judge where both orders differ
constexpr int kHalvings = 3;
constexpr int kCells = kMostCellsInStep;
constexpr int kAsk = -1;  // level of a judge who is not asked

// FNV-1a over the bits of numbers.
class Hash {
 public:
  explicit Hash(std::uint64_t& sum) : sum_(sum) {}
  void add(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    for (int i = 0; i < 8; ++i) sum_ = (sum_ ^ (bits >> 8 * i & 0xffu)) * 0x100000001b3u;
  }
  void add_all(const Vec3& v) {
    for (const double x : v) add(x);
  }
  void add_all(const Mat3& m) {
    for (const Vec3& column : m.columns) add_all(column);
  }
  void add(const VolumeMetrics& m) {
    for (const double x : {m.volume, m.area, m.counter_area, m.depth_moment, m.depth,
                           m.volume_error, static_cast<double>(m.status)}) {
      add(x);
    }
    for (const Vec3& v : {m.centroid, m.area_vector, m.area_moment}) add_all(v);
    add_all(m.inertia);
  }
  void add(const Interference& answer) {
    add(static_cast<double>(answer.engine));
    add(answer.total);
    for (const VolumeMetrics& site : answer.sites) add(site);
  }

 private:
  std::uint64_t& sum_;
};

class CaseJudge {
 public:
  CaseJudge(const SearchCase& c, SearchOutcome& outcome, InterferenceWorkspace& workspace)
      : c_(c), outcome_(outcome), workspace_(workspace) {
    options_.most_cells = kCells;
    if (c.family == SearchFamily::kComposed) options_.tolerance = 1e-2;
    body_ = std::min(c.a.implicit.most_volume, c.b.implicit.most_volume);
  }

  void run(Interference& result, Interference& mirrored, int level, std::uint64_t seed) {
    result_ = &result;
    evaluate(c_.a.shape, c_.b.shape, c_.X_AB, result);
    evaluate(c_.b.shape, c_.a.shape, c_.X_AB.inverse(), mirrored);
    outcome_.engine = result.engine;
    outcome_.overlapping = result.total.touching();
    if (outcome_.seconds > kSlow) fail("slow", result, outcome_.seconds, 0.0);
    if (is_faulty(result) || is_faulty(mirrored)) return;
    const VolumeMetrics &m = result.total, &n = mirrored.total;
    const bool differ = !(std::abs(m.volume - n.volume) <=
                          m.volume_error + n.volume_error + kRounding * body_ + far_rounding());
    if (level != kAsk) {
      LineOracle judge(c_.a.implicit, c_.b.implicit.posed(c_.X_AB), seed);
      compare(result, judge, differ ? std::max(level, kCloser) : level);
      if (differ && outcome_.failures.empty()) compare(mirrored, judge, kCloser);
      if (differ && outcome_.failures.empty()) {
        fail("another volume in the other order", result, n.volume, n.volume_error);
      }
    }
    Random random(seed + 17);
    if (m.touching() && random.uniform() < kMotions) move(random);
  }

 private:
  void evaluate(const Shape& a, const Shape& b, const Pose& X, Interference& out) {
    const std::clock_t begin = std::clock();  // of the processor: others may keep it busy
    interference(a, b, X, options_, workspace_, out);
    outcome_.seconds =
        std::max(outcome_.seconds, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    Hash(outcome_.answers).add(out);
  }

  void fail(const char* what, const Interference& answer, double expected, double doubt) {
    outcome_.failures.push_back({what, answer.engine, answer.total.status, c_.a.text, c_.b.text,
                                 python_pose(c_.X_AB), answer.total.volume,
                                 answer.total.volume_error, expected, doubt});
  }

  // Half-spaces meet bodies far from their origin, where the inverse of the pose rounds.
  double far_rounding() const {
    const VolumeMetrics& m = result_->total;
    return 1e-15 * c_.X_AB.translation.norm() * std::max(m.area, m.counter_area);
  }

  // Faults that can be seen without a judge; those of which the rest makes no sense end a case.
  bool is_faulty(const Interference& answer) {
    const VolumeMetrics& m = answer.total;
    bool finite = is_finite(m);
    for (const VolumeMetrics& site : answer.sites) finite = finite && is_finite(site);
    const char* what = nullptr;
    if (!finite) what = "not finite";
    if (m.status == Status::kInvalid || m.status == Status::kUnbounded) what = "not answered";
    if (m.volume < 0.0 || m.volume_error < 0.0) what = "negative";
    if (m.volume > (1.0 + kSiteSum) * body_ + m.volume_error) what = "larger than a solid";
    if (what) {
      fail(what, answer, body_, 0.0);
      return true;
    }
    const double deepest = 10.0 * std::min(c_.a.size, c_.b.size);
    if (m.depth_moment < 0.0 || m.depth_moment > deepest * m.volume) {
      fail("impossible depth moment", answer, m.depth_moment, 0.0);
    }
    double sum = 0.0;
    for (const VolumeMetrics& site : answer.sites) sum += site.volume;
    if (std::abs(sum - m.volume) > kSiteSum * m.volume) {
      fail("sites that do not add up", answer, sum, 0.0);
    }
    const double least = std::min(m.area, m.counter_area), length = m.area_vector.norm();
    const double slack = 1e-9 * std::pow(std::min(c_.a.size, c_.b.size), 2);
    if (m.volume > kSliver * body_ && length > 1.05 * least + slack) {
      fail("area vector longer than an area", answer, length / least, 0.0);
    }
    return false;
  }

  void compare(const Interference& answer, LineOracle& judge, int level) {
    const VolumeMetrics& m = answer.total;
    const double none = kRounding * body_ + far_rounding();
    if (judge.is_apart()) {
      outcome_.level = 0;
      if (m.volume > m.volume_error + none) fail("overlap where none is", answer, 0.0, 0.0);
      return;
    }
    const std::size_t members = c_.a.implicit.members().size() + c_.b.implicit.members().size();
    const int last = std::max(members <= 2 ? 4 : 3, level);
    LineEstimate before;
    bool judged = false;
    for (const int first = level; level <= last; ++level) {
      const LineEstimate lines = judge.estimate(level);
      double doubt = lines.volume_error + 1e-15 * lines.extent * lines.extent * lines.extent;
      if (level > first) doubt = std::max(doubt, 0.25 * std::abs(lines.volume - before.volume));
      before = lines;
      const double error = std::abs(m.volume - lines.volume);
      const double excess = error - m.volume_error - none;
      outcome_.level = level;
      if (lines.volume > 0.0) {
        outcome_.error = error / lines.volume;
        outcome_.doubt = doubt / lines.volume;
      }
      // A false alarm at the first look costs no more than another one.
      if (excess <= (level == first ? 0.5 * doubt : doubt)) {
        // A miss of a whole overlap is no agreement, be the doubt as large as it may.
        judged = m.touching() || lines.volume <= none;
        if (judged) break;
        continue;
      }
      if (level == first || doubt > 0.2 * excess) continue;
      if (!m.touching()) {
        fail("missed", answer, lines.volume, doubt);
      } else if (lines.volume <= none) {
        fail("overlap where none is", answer, lines.volume, doubt);
      } else {
        const bool wrong = excess > kWrong * lines.volume && m.status != Status::kApproximate;
        fail(wrong ? "wrong volume" : "beyond the bound", answer, lines.volume, doubt);
      }
      return;
    }
    outcome_.undecided = !judged;
    if (judged && m.touching() && &answer == result_) {
      compare_moments(judge, before, std::min(level, last));
    }
  }

  // Centroid and area vector, where V agrees.
  void compare_moments(LineOracle& judge, LineEstimate lines, int level) {
    const VolumeMetrics& m = result_->total;
    if (!(m.volume > 1e3 * m.volume_error && m.volume > kSliver * body_)) return;
    const double gyration = std::sqrt(std::max(0.0, m.second_moment().trace() / m.volume));
    const double area = std::max(m.area, m.counter_area);
    const bool directed = !c_.special && m.status != Status::kContained;
    for (int looks = 0; looks < 3; ++looks) {
      const double off = (m.centroid - lines.centroid).norm();
      const double turned = (m.area_vector - lines.area_vector).norm();
      const double count = 610.0 * std::pow(6.85, level);
      const double of_lines = 8.0 * lines.extent * lines.extent * std::pow(count, -0.75);
      // Few lines meet a needle: their mean is that of chance.
      if (lines.share < kLeastShare) return;
      const bool vague = lines.volume_error > 0.05 * lines.volume;
      const bool moved = !vague && off > lines.centroid_error + kCentroid * gyration + 1e-13;
      const bool leaned = !vague && directed && turned > kAreaVector * area + of_lines;
      if (!vague && !moved && !leaned) return;
      if (looks == 2 || level + 1 >= LineOracle::kLevels - 1) {
        if (moved) return fail("wrong centroid", *result_, off / gyration, 0.0);
        if (leaned && of_lines < 0.5 * turned)
          return fail("wrong area vector", *result_, turned / area, 0.0);
        return;
      }
      lines = judge.estimate(++level);
    }
  }

  // ---- Motions
  // -----------------------------------------------------------------------------------

  struct Place {
    double volume, error, rate;
  };
  Place at(const Pose& X, const Vec3& shift, const Vec3& angle) {
    Interference out;
    evaluate(c_.a.shape, c_.b.shape, X, out);
    const VolumeMetrics& m = out.total;
    return {m.volume, m.volume_error, -(m.area_vector.dot(shift) + m.area_moment.dot(angle))};
  }
  // V rises between its rates at both ends.
  bool fits(const Place& from, const Place& to) const {
    const double rise = to.volume - from.volume;
    const double allowed = std::abs(to.rate - from.rate) + from.error + to.error +
                           kIncrement * std::max(std::abs(from.rate), std::abs(to.rate)) +
                           kRounding * body_;
    return std::abs(rise - 0.5 * (from.rate + to.rate)) <= allowed;
  }
  void move(Random& random) {
    // No farther than the overlap is thick: from all of a disc to none of it V is not smooth, and
    // no rate at either end tells of that.
    const VolumeMetrics& m = result_->total;
    const double thick = m.volume / std::max(m.area, m.counter_area);
    double step = random.log_uniform(1e-6, 1e-2) * std::min(c_.a.size, c_.b.size);
    if (thick > 0.0) step = std::min(step, thick);
    Vec3 shift = step * random.direction();
    Vec3 angle = random.uniform() < 0.5 ? Vec3(step * random.direction()) : Vec3(Vec3::Zero());
    Pose X = c_.X_AB;
    constexpr int kSteps = 4;
    for (int i = 0; i < kSteps; ++i) {
      const Pose next = screwed(X, shift, angle);
      if (is_broken(X, next, shift, angle, kHalvings)) {
        Interference out;
        evaluate(c_.a.shape, c_.b.shape, broken_at_, out);
        SearchFailure failure{"increment of V against S and T",
                              out.engine,
                              out.total.status,
                              c_.a.text,
                              c_.b.text,
                              python_pose(broken_at_),
                              out.total.volume,
                              out.total.volume_error,
                              broken_rise_,
                              broken_rate_};
        outcome_.failures.push_back(failure);
        return;
      }
      X = next;
    }
  }
  // A bend of V between two places is none at half the distance; a jump stays.
  bool is_broken(const Pose& X, const Pose& next, const Vec3& shift, const Vec3& angle,
                 int halvings) {
    const Place from = at(X, shift, angle), to = at(next, shift, angle);
    if (fits(from, to)) return false;
    if (halvings == 0) {
      broken_at_ = X;
      broken_rise_ = to.volume - from.volume;
      broken_rate_ = 0.5 * (from.rate + to.rate);
      return true;
    }
    const Pose middle = screwed(X, 0.5 * shift, 0.5 * angle);
    return is_broken(X, middle, 0.5 * shift, 0.5 * angle, halvings - 1) ||
           is_broken(middle, next, 0.5 * shift, 0.5 * angle, halvings - 1);
  }

  const SearchCase& c_;
  SearchOutcome& outcome_;
  InterferenceWorkspace& workspace_;
  InterferenceOptions options_;
  double body_;
  const Interference* result_ = nullptr;
  Pose broken_at_;
  double broken_rise_ = 0.0, broken_rate_ = 0.0;
};

}  // namespace

SearchOutcome PairSearch::run(const SearchCase& c, int level, std::uint64_t seed) {
  SearchOutcome outcome{.family = c.family, .failures = {}};
  CaseJudge(c, outcome, workspace_).run(result_, mirrored_, level, seed);
  return outcome;
}

SearchOutcome PairSearch::ask(const SearchCase& c, std::uint64_t seed) {
  return run(c, kAsk, seed);
}

}  // namespace volcontact::test
