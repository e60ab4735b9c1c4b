// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_sites.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr double kSampleStep = kPi / 24.0;  // between half-planes, at most [rad]
constexpr int kLeastSamples = 8;            // of an arc
constexpr int kBesideRounds = 8;            // each of them narrows a search to two ninths
constexpr double kBesideShare = 0.25;       // of the way to the next half-plane, again and again
constexpr double kLeastBeside = 1e-12;      // of that way
constexpr int kEndRounds = 9;               // each of them narrows an end to a fifth
constexpr double kEndWidth = 1e-4;          // to which an end is known, of the range

class SiteSearch {
 public:
  SiteSearch(const ConvexView& body, const Pose& X, SimdPath path,
             const std::vector<TorusExit>& exits, TorusSection& sections, TorusSites& sites)
      : body_(body), X_(X), path_(path), exits_(exits), sections_(sections), s_(sites) {}

  void run() {
    s_.ranges.clear();
    s_.samples.clear();
    find_torus_arcs(body_, X_, sections_.faces().major, sections_.faces().minor, s_.arcs);
    if (s_.arcs.doubtful.empty()) return;
    for (const double angle : s_.arcs.met) s_.samples.push_back({angle, 0.0, true});
    add_samples();
    read_samples();
  }

 private:
  using Arc = TorusArcs::Arc;
  using Sample = TorusSites::Sample;

  // Half-planes all over the doubtful arcs.
  void add_samples() {
    for (const Arc& arc : s_.arcs.doubtful) {
      const double width = arc.high - arc.low;
      const int parts = std::max(kLeastSamples, static_cast<int>(std::ceil(width / kSampleStep)));
      for (int i = 0; i <= parts; ++i) {
        s_.samples.push_back({arc.low + width * i / parts, 0.0});
      }
    }
    for (const TorusExit& exit : exits_) {
      if (exit.all && exit.width() < 2.0 * kSampleStep) s_.samples.push_back({exit.middle(), 0.0});
    }
    for (Sample& sample : s_.samples) {
      if (sample.angle < s_.arcs.start - kPi) sample.angle += 2.0 * kPi;
      if (sample.angle >= s_.arcs.start + kPi) sample.angle -= 2.0 * kPi;
    }
    std::sort(s_.samples.begin(), s_.samples.end(),
              [](const Sample& a, const Sample& b) { return a.angle < b.angle; });
    s_.samples.erase(std::unique(s_.samples.begin(), s_.samples.end(),
                                 [](const Sample& a, const Sample& b) {
                                   return b.angle - a.angle < TorusArcs::kNothing;
                                 }),
                     s_.samples.end());
    for (std::size_t from = 0; from < s_.samples.size(); from += kLanes) {
      double angle[kLanes], length[kLanes];
      for (std::size_t i = 0; i < kLanes; ++i) {
        angle[i] = s_.samples[std::min(from + i, s_.samples.size() - 1)].angle;
      }
      probe(angle, length);
      for (std::size_t i = 0; i < kLanes && from + i < s_.samples.size(); ++i) {
        s_.samples[from + i].length = length[i];
      }
    }
    look_beside();
  }

  // A half-plane where a ball meets the body may but touch it, in a corner or an edge: then the
  // overlap lies beside it.
  void look_beside() {
    for (std::size_t i = 0; i < s_.samples.size(); ++i) {
      const Sample sample = s_.samples[i];
      const bool last = i + 1 == s_.samples.size();
      if (!sample.met || sample.length > 0.0) continue;
      if ((i > 0 && s_.samples[i - 1].length > 0.0) || (!last && s_.samples[i + 1].length > 0.0)) {
        continue;
      }
      const double low = i > 0 ? s_.samples[i - 1].angle : sample.angle - kSampleStep;
      const double high = last ? sample.angle + kSampleStep : s_.samples[i + 1].angle;
      Sample found = longest_between(low, high);
      if (!(found.length > 0.0)) found = close_to(sample.angle, low, high);
      if (!(found.length > 0.0)) continue;
      const bool before = found.angle < sample.angle;
      s_.samples.insert(s_.samples.begin() + static_cast<std::ptrdiff_t>(before ? i : i + 1),
                        found);
      ++i;
    }
  }

  // A half-plane between two with a column, or about the one that is nearest to having one.
  Sample longest_between(double low, double high) {
    Sample best{};
    for (int round = 0; round < kBesideRounds; ++round) {
      double angle[kLanes], length[kLanes];
      const double step = (high - low) / (kLanes + 1);
      for (int i = 0; i < kLanes; ++i) angle[i] = low + (i + 1) * step;
      probe(angle, length);
      const auto most = std::max_element(length, length + kLanes) - length;
      best = {angle[most], length[most]};
      if (best.length > 0.0) break;
      low = best.angle - step;
      high = best.angle + step;
    }
    return best;
  }

  // A half-plane with a column at any distance from one that may lie in a face of a thin plate: of
  // those beside it without one none is nearer to having one than another.
  Sample close_to(double angle_met, double low, double high) {
    Sample best{};
    for (double share = kBesideShare; share > kLeastBeside && !(best.length > 0.0);) {
      double angle[kLanes], length[kLanes];
      for (int i = 0; i < kLanes; i += 2, share *= kBesideShare) {
        angle[i] = angle_met - share * (angle_met - low);
        angle[i + 1] = angle_met + share * (high - angle_met);
      }
      probe(angle, length);
      const auto most = std::max_element(length, length + kLanes) - length;
      best = {angle[most], length[most]};
    }
    return best;
  }

  void probe(const double* angle, double* length) {
    double cos[kLanes], sin[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      cos[i] = std::cos(angle[i]);
      sin[i] = std::sin(angle[i]);
    }
    sections_.probe(path_, cos, sin, length);
  }

  // Whether an arc that a plane parts from the body lies between two angles next to each other.
  bool parted(double from, double to) const {
    const double middle = 0.5 * (from + to);
    for (const Arc& arc : s_.arcs.doubtful) {
      if (turned_near(middle, 0.5 * (arc.low + arc.high)) >= arc.low - TorusArcs::kNothing &&
          turned_near(middle, 0.5 * (arc.low + arc.high)) <= arc.high + TorusArcs::kNothing) {
        return false;
      }
    }
    return true;
  }

  void read_samples() {
    const std::vector<Sample>& all = s_.samples;
    const std::size_t n = all.size();
    const auto next = [&](std::size_t i) {
      return i + 1 < n ? all[i + 1].angle : all[0].angle + 2.0 * kPi;
    };
    const auto goes_on = [&](std::size_t i) {  // from a full place to the next one
      return all[(i + 1) % n].length > 0.0 && !parted(all[i].angle, next(i));
    };
    std::size_t first = n;  // a full one after a gap
    bool any = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (!(all[i].length > 0.0)) continue;
      any = true;
      const std::size_t before = (i + n - 1) % n;
      if (!(all[before].length > 0.0) || !goes_on(before)) first = i;
    }
    if (!any) return;
    if (first == n) {
      s_.ranges.push_back({s_.arcs.start - kPi, s_.arcs.start + kPi, s_.arcs.start - kPi,
                           s_.arcs.start + kPi, true});
      return;
    }
    for (std::size_t k = 0; k < n;) {
      const std::size_t from = first + k;
      if (!(all[from % n].length > 0.0)) {
        ++k;
        continue;
      }
      std::size_t to = from;
      while (to + 1 < first + n && goes_on(to % n)) ++to;
      add_range(from, to);
      k = to + 1 - first;
    }
  }

  double angle_at(std::size_t i) const {
    const std::size_t n = s_.samples.size();
    return s_.samples[i % n].angle + 2.0 * kPi * static_cast<double>(i / n);
  }

  // From the samples number `from` to `to`, which are full, to the empty ones beside them.
  void add_range(std::size_t from, std::size_t to) {
    const std::size_t n = s_.samples.size();
    double full[2] = {angle_at(from), angle_at(to)};
    double empty[2] = {angle_at(from + n - 1) - 2.0 * kPi, angle_at(to + 1)};
    for (int round = 0; round < kEndRounds; ++round) {
      const double width = kEndWidth * (full[1] - full[0]);
      if (full[0] - empty[0] <= width && empty[1] - full[1] <= width) break;
      constexpr int kParts = kLanes / 2 + 1;
      double angle[kLanes], length[kLanes], cos[kLanes], sin[kLanes];
      for (int end = 0; end < 2; ++end) {
        const double step = (empty[end] - full[end]) / kParts;
        const double c = std::cos(step), s = std::sin(step);
        double u = std::cos(full[end]), v = std::sin(full[end]);
        for (int i = 1; i < kParts; ++i) {
          const int lane = end * (kParts - 1) + i - 1;
          const double turned = c * u - s * v;
          v = s * u + c * v;
          u = turned;
          angle[lane] = full[end] + i * step;
          cos[lane] = u;
          sin[lane] = v;
        }
      }
      sections_.probe(path_, cos, sin, length);
      for (int end = 0; end < 2; ++end) {
        const double from_empty = empty[end];
        for (int i = 1; i < kParts; ++i) {
          const int lane = end * (kParts - 1) + i - 1;
          if (!(length[lane] > 0.0)) {
            empty[end] = angle[lane];
            break;
          }
          full[end] = angle[lane];
          empty[end] = i + 1 < kParts ? angle[lane + 1] : from_empty;
        }
      }
    }
    s_.ranges.push_back({empty[0], empty[1], full[0], full[1], false});
  }

  const ConvexView& body_;
  const Pose& X_;
  SimdPath path_;
  const std::vector<TorusExit>& exits_;
  TorusSection& sections_;
  TorusSites& s_;
};

}  // namespace

void find_torus_sites(const ConvexView& body, const Pose& X, SimdPath path,
                      const std::vector<TorusExit>& exits, TorusSection& sections,
                      TorusSites& sites) {
  SiteSearch(body, X, path, exits, sections, sites).run();
}

}  // namespace volcontact
