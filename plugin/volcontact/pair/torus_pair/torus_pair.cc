// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/torus_pair.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/disjoint_sets.h"
#include "volcontact/pair/quadrature/outer_rule.h"
#include "volcontact/pair/quadrature/small_turn.h"

namespace volcontact {
namespace {

constexpr double kFirstTarget = 0.1;  // share of the tolerance: of an answer at the first look
constexpr double kPartTarget = 2e-2;  // of a part of the surface
constexpr double kNarrow = 0.5, kPanel = 1.6;  // arcs for fewer nodes, and for one panel [rad]
constexpr int kWholeSteps = 12;                // integrate harmonics to number 11
constexpr double kAllArea = 1e-6;              // by which the surface of a contained ring is known
constexpr double kOnlyTouch = 1e-9;  // depth per radius of two rings that have no surface in common

constexpr double kOneHint = 0.02;    // of angles next to each other: one is enough [rad]
constexpr double kIdentical = 1e-7;  // of a radius

class TorusPairRun {
 public:
  TorusPairRun(const Torus& a, const Torus& b, const Pose& X_AB, const InterferenceOptions& options,
               TorusPairScratch& scratch, Interference& out)
      : tori_{&a, &b},
        size_{{a.major_radius(), a.minor_radius()}, {b.major_radius(), b.minor_radius()}},
        X_AB_(X_AB),
        X_BA_(X_AB.inverse()),
        options_(options),
        s_(scratch),
        out_(out) {}

  /// Round 0 knows nothing; 1 has seen the ends of all arcs, and 2 looks at more circles.
  bool run(int round) {
    const bool fine = round == 2;
    out_.sites.clear();
    out_.total = VolumeMetrics{};
    if (settle_identical()) return true;
    const PatchEffort effort{kPartTarget * options_.tolerance * (fine ? 0.1 : 1.0), fine,
                             fine ? 32 : 8};
    s_.patch[0].hints.clear();
    if (round > 0) set_hints(0, true);
    find_patch(size_[0], X_BA_, size_[1], effort, s_.patch[0]);
    if (patch(0).apart) return true;
    set_hints(1, round > 0);
    find_patch(size_[1], X_AB_, size_[0], effort, s_.patch[1]);
    if (patch(0).incomplete || patch(1).incomplete) return false;
    if (patch(0).arcs.empty() || patch(1).arcs.empty()) return settle_contained();
    join_chains();
    set_regions();
    integrate();
    set_depths();
    for (const Region& region : s_.regions) add_site(region);
    const double target = (fine ? 1.0 : kFirstTarget) * options_.tolerance;
    return out_.total.touching() && out_.total.volume_error <= target * out_.total.volume;
  }

 private:
  using Region = TorusPairScratch::Region;

  const TorusPatch& patch(int side) const { return s_.patch[side].patch; }
  const Pose& pose(int side) const { return side == 0 ? kHere : X_AB_; }
  Circle circle(int side, double angle) const {
    return section_circle(size_[side], pose(side), angle);
  }

  // Arcs of the other surface end on this one: where a thin ring passes through a thick one, they
  // are all there is to be seen of a small patch. Of a row of them the middle, which a patch of two
  // halves may not have: `more` places beside it tell of both.
  void set_hints(int side, bool more) {
    std::vector<double>& hints = s_.patch[side].hints;
    hints.clear();
    for (const TorusPatch::Slice& slice : patch(1 - side).slices) {
      const Circle there = circle(1 - side, slice.angle);
      for (int i = slice.first; i < slice.last; ++i) {
        const TorusPatch::Arc& arc = patch(1 - side).arcs[i];
        if (whole(arc)) continue;
        for (double end : {arc.low, arc.high}) {
          const Vec3 x = side == 0 ? there.at(end) : X_BA_ * there.at(end);
          hints.push_back(std::atan2(x.y(), x.x()));
        }
      }
    }
    std::sort(hints.begin(), hints.end());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < hints.size();) {
      std::size_t next = i + 1;
      while (next < hints.size() && hints[next] - hints[next - 1] < kOneHint) ++next;
      const double low = hints[i], high = hints[next - 1];
      hints[kept++] = 0.5 * (low + high);
      if (more && high - low > kOneHint) {  // then there are three or more
        hints[kept++] = 0.75 * low + 0.25 * high;
        hints[kept++] = 0.25 * low + 0.75 * high;
      }
      i = next;
    }
    hints.resize(kept);
  }

  // Rings so much alike that rounding decides which surface is in front: V is known all the same.
  bool settle_identical() {
    const Vec3 axis = X_AB_.rotation.col(2);
    const double off = X_AB_.translation.norm() + size_[0].major * std::hypot(axis.x(), axis.y()) +
                       std::abs(size_[0].major - size_[1].major) +
                       std::abs(size_[0].minor - size_[1].minor);
    if (!(off < kIdentical * size_[0].minor)) return false;
    out_.total = tori_[0]->own_metrics();
    out_.total.status = Status::kContained;
    out_.total.volume_error = 4.0 * kPi * kPi * size_[0].major * size_[0].minor * off;
    out_.sites.push_back(out_.total);
    return true;
  }

  // No surface of one of them lies in the other.
  bool settle_contained() {
    const bool in_b = !patch(0).arcs.empty(), in_a = !patch(1).arcs.empty();
    if (!in_a && !in_b) return deepest() < kOnlyTouch * std::min(size_[0].minor, size_[1].minor);
    const int side = in_a ? 1 : 0;
    double turn = 0.0;
    for (const TorusPatch::Slice& slice : patch(side).slices) {
      for (int i = slice.first; i < slice.last; ++i) {
        turn += slice.weight * (patch(side).arcs[i].high - patch(side).arcs[i].low);
      }
    }
    if (std::abs(turn - 4.0 * kPi * kPi) > kAllArea * turn) return false;
    out_.total = transformed(tori_[side]->own_metrics(), pose(side));
    out_.total.status = Status::kContained;
    out_.sites.push_back(out_.total);
    return true;
  }

  double deepest() const {
    double depth = 0.0;
    for (int i = 0; i < 2; ++i) {
      const auto look = [&](double angle) {
        depth =
            std::max(depth, touch_of(size_[i], i == 0 ? X_BA_ : X_AB_, size_[1 - i], angle).depth);
      };
      for (double angle : patch(i).nearest) look(angle);
      for (int k = 0; k < 8; ++k) look(0.25 * kPi * k);
    }
    return depth;
  }

  int root(int chain) const { return root_of(s_.region_of, chain); }
  void join(int one, int other) { join_sets(s_.region_of, one, other); }
  int chain(int side, const TorusPatch::Arc& arc) const {
    return arc.chain + (side == 0 ? 0 : patch(0).chains);
  }

  // Parts of either surface by their chains, and parts of both where arcs end in one place.
  void join_chains() {
    make_sets(s_.region_of, static_cast<std::size_t>(patch(0).chains + patch(1).chains));
    for (int side = 0; side < 2; ++side) {
      const int base = side == 0 ? 0 : patch(0).chains;
      for (const TorusPatch::Joint& j : patch(side).joints) join(base + j.one, base + j.other);
    }
    if (parts(0) == 1 && parts(1) == 1) {
      join(0, patch(0).chains);
      return;
    }
    for (int side = 0; side < 2; ++side) {
      const TorusPatch& p = patch(side);
      for (std::size_t k = 0; k < p.slices.size(); ++k) {
        for (int i = p.slices[k].first; i < p.slices[k].last; ++i) {
          if (in_middle_of_chain(p, k, i)) glue(side, p.slices[k], p.arcs[i]);
        }
      }
    }
  }

  int parts(int side) const {
    const int base = side == 0 ? 0 : patch(0).chains;
    int count = 0;
    for (int i = 0; i < patch(side).chains; ++i) count += root(base + i) == base + i;
    return count;
  }

  // Of the arcs of a chain, which stand in a row, the one in the middle.
  static bool in_middle_of_chain(const TorusPatch& p, std::size_t slice, int arc) {
    std::size_t first = slice, last = slice;
    const auto holds = [&](std::size_t k) {
      for (int i = p.slices[k].first; i < p.slices[k].last; ++i) {
        if (p.arcs[i].chain == p.arcs[arc].chain) return true;
      }
      return false;
    };
    while (first > 0 && holds(first - 1)) --first;
    while (last + 1 < p.slices.size() && holds(last + 1)) ++last;
    return slice == (first + last) / 2;
  }

  // To the arcs of the other surface that end nearest to the ends of this one.
  void glue(int side, const TorusPatch::Slice& slice, const TorusPatch::Arc& arc) {
    if (whole(arc)) return;
    const Circle here = circle(side, slice.angle);
    const TorusPatch& others = patch(1 - side);
    for (double end : {arc.low, arc.high}) {
      const Vec3 x = here.at(end);
      double least = kInfinity;
      int nearest = -1;
      for (const TorusPatch::Slice& k : others.slices) {
        const Circle there = circle(1 - side, k.angle);
        if (std::pow(std::max(0.0, (there.center - x).norm() - there.radius), 2) > least) continue;
        for (int i = k.first; i < k.last; ++i) {
          const TorusPatch::Arc& other = others.arcs[i];
          if (whole(other)) continue;
          for (double other_end : {other.low, other.high}) {
            const double way = (there.at(other_end) - x).squaredNorm();
            if (way < least) {
              least = way;
              nearest = chain(1 - side, other);
            }
          }
        }
      }
      if (nearest >= 0) join(chain(side, arc), nearest);
    }
  }

  static bool whole(const TorusPatch::Arc& arc) { return arc.high - arc.low >= 2.0 * kPi; }

  Region& region(int side, const TorusPatch::Arc& arc) {
    const int at = root(chain(side, arc));
    for (Region& r : s_.regions) {
      if (r.chain == at) return r;
    }
    s_.regions.push_back({at, Vec3::Zero(), 0.0, 0.0, 0.0, {}});
    return s_.regions.back();
  }

  template <typename Use>
  void each_arc(Use&& use) {
    for (int side = 0; side < 2; ++side) {
      for (const TorusPatch::Slice& slice : patch(side).slices) {
        const Circle here = circle(side, slice.angle);
        for (int i = slice.first; i < slice.last; ++i) {
          const TorusPatch::Arc& arc = patch(side).arcs[i];
          use(side, slice, here, arc, region(side, arc));
        }
      }
    }
  }

  void set_regions() {
    s_.regions.clear();
    each_arc([&](int, const TorusPatch::Slice& slice, const Circle& here,
                 const TorusPatch::Arc& arc, Region& r) {
      const double weight = slice.weight * (arc.high - arc.low);
      r.origin += weight * (whole(arc) ? here.center : here.at(0.5 * (arc.low + arc.high)));
      r.weight += weight;
    });
    for (Region& r : s_.regions) r.origin /= r.weight;
  }

  void integrate() {
    each_arc([&](int side, const TorusPatch::Slice& slice, const Circle& here,
                 const TorusPatch::Arc& arc, Region& r) {
      const double width = arc.high - arc.low, weight = slice.weight * size_[side].minor;
      if (whole(arc)) {
        for (int i = 0; i < kWholeSteps; ++i) {
          add_place(side, here, SmallTurn::any(2.0 * kPi * i / kWholeSteps),
                    weight * 2.0 * kPi / kWholeSteps, r);
        }
        return;
      }
      const int panels = static_cast<int>(std::ceil(width / kPanel));
      const double part = width / panels;
      for (int k = 0; k < panels; ++k) {
        const SmallTurn middle = SmallTurn::any(arc.low + (k + 0.5) * part);
        const auto add = [&](double node, double share) {
          const SmallTurn turn((node - 0.5) * part);
          add_place(side, here,
                    {turn.cos * middle.cos - turn.sin * middle.sin,
                     turn.cos * middle.sin + turn.sin * middle.cos},
                    weight * part * share, r);
        };
        if (part < kNarrow) {
          for (int i = 0; i < 5; ++i) add(GaussRule<5>::kNodes[i], GaussRule<5>::kWeights[i]);
        } else {
          for (int i = 0; i < kLanes; ++i) add(OuterRule::kNodes[i], OuterRule::kWeights[i]);
        }
      }
    });
  }

  // `weight` is that of the surface per distance from the axis of the ring.
  void add_place(int side, const Circle& here, const SmallTurn& at, double weight, Region& r) {
    const Vec3 n = at.cos * here.u + at.sin * here.v, x = here.center - r.origin + here.radius * n;
    const double area = weight * (size_[side].major + here.radius * at.cos);
    r.flux[side].add(x, area * n, mean_depth(r.origin, x));
    r.reach = std::max(r.reach, x.squaredNorm());
  }

  // int s^2 w(o + s x) ds, w the mean of the depths under both surfaces.
  double mean_depth(const Vec3& origin, const Vec3& x) const {
    const Vec3 origin_B = X_BA_ * origin, x_B = X_BA_.rotation * x;
    return integral_from_origin([&](double s) {
      return -0.25 * (torus_value(size_[0], origin + s * x) / size_[0].minor +
                      torus_value(size_[1], origin_B + s * x_B) / size_[1].minor);
    });
  }

  // Of every place of deepest touch, to the region next to it.
  void set_depths() {
    for (int side = 0; side < 2; ++side) {
      for (double angle : patch(side).nearest) {
        const TorusTouch touch =
            touch_of(size_[side], side == 0 ? X_BA_ : X_AB_, size_[1 - side], angle);
        const Vec3 x = side == 0 ? X_AB_ * touch.middle : touch.middle;
        give_depth(x, touch.depth);
      }
    }
    each_arc([&](int side, const TorusPatch::Slice& slice, const Circle&, const TorusPatch::Arc&,
                 Region& r) {
      if (side == 1 || r.depth > 0.0) return;
      r.depth = touch_of(size_[0], X_BA_, size_[1], slice.angle).depth;
    });
  }
  void give_depth(const Vec3& x, double depth) {
    double least = kInfinity;
    Region* nearest = nullptr;
    each_arc([&](int, const TorusPatch::Slice&, const Circle& here, const TorusPatch::Arc& arc,
                 Region& r) {
      const double way = (here.at(0.5 * (arc.low + arc.high)) - x).squaredNorm();
      if (way < least) {
        least = way;
        nearest = &r;
      }
    });
    if (nearest) nearest->depth = std::max(nearest->depth, depth);
  }

  void add_site(const Region& r) {
    const TorusFlux &a = r.flux[0], &b = r.flux[1];
    const Vec3 volume = a.volume + b.volume;
    MomentSum sum;
    sum.volume = volume.sum() / 3.0;
    sum.first = 0.25 * (a.first + b.first);
    sum.second = 0.2 * (a.second + b.second);
    // The error of a vector goes with its area, and a small area bounds what it can be.
    const double square_a = a.area * a.area, square_b = b.area * b.area;
    const double share_b = square_a + square_b > 0.0 ? square_a / (square_a + square_b) : 0.5;
    sum.area_vector = (1.0 - share_b) * a.vector - share_b * b.vector;
    sum.area_moment = (1.0 - share_b) * a.moment - share_b * b.moment;
    sum.area = a.area;
    sum.counter_area = b.area;
    VolumeMetrics metrics = sum.metrics();
    if (!metrics.touching()) return;
    metrics.depth_moment = std::max(0.0, a.depth_moment + b.depth_moment);
    metrics.depth = r.depth;
    // The surface of a region is closed, and each of three fluxes is its volume.
    const double open = (a.vector + b.vector).norm() * std::sqrt(r.reach);
    const double spread = volume.maxCoeff() - volume.minCoeff();
    const double known = patch(0).error + patch(1).error;
    metrics.volume_error = spread + kOpenShare * open + known;
    metrics = transformed(metrics, {Mat3::Identity(), r.origin});
    out_.total = out_.sites.empty() ? metrics : out_.total + metrics;
    out_.sites.push_back(metrics);
  }

  static constexpr double kOpenShare = 0.1;
  static inline const Pose kHere{};

  const Torus* tori_[2];
  TorusSize size_[2];
  const Pose& X_AB_;
  const Pose X_BA_;
  const InterferenceOptions& options_;
  TorusPairScratch& s_;
  Interference& out_;
};

}  // namespace

bool torus_pair(const Torus& a, const Torus& b, const Pose& X_AB,
                const InterferenceOptions& options, TorusPairScratch& scratch, Interference& out) {
  out.sites.clear();
  out.total = VolumeMetrics{};
  if (!(a.own_metrics().volume > 0.0) || !(b.own_metrics().volume > 0.0)) return true;
  TorusPairRun run(a, b, X_AB, options, scratch, out);
  return run.run(0) || run.run(1) || run.run(2);
}

}  // namespace volcontact
