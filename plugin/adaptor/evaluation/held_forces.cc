// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/held_forces.h"

#include <algorithm>
#include <cstddef>

#include "adaptor/evaluation/report_sums.h"
#include "adaptor/evaluation/stiff_sites.h"

namespace volcontact::adaptor {
namespace {

void set_forces(const HeldSite& held, SiteReport& site) {
  site.normal_force = held.normal_force();
  site.force_on_A = held.force();
  site.torque_on_A =
      held.torque() + (held.centroid() - site.metrics.centroid).cross(site.force_on_A);
}

// Forces that were solved at other poses act at the present sites.
void set_forces(const UserdataBlock& our, int first, int count, ContactReport& report) {
  if (report.sites.empty()) return;
  if (static_cast<std::size_t>(count) == report.sites.size()) {
    for (int i = 0; i < count; ++i) {
      set_forces(our.solved_site(first + i), report.sites[static_cast<std::size_t>(i)]);
    }
    return;
  }
  for (SiteReport& site : report.sites) {
    site.normal_force = 0.0;
    site.force_on_A.setZero();
    site.torque_on_A.setZero();
  }
  SiteReport& largest = *std::max_element(
      report.sites.begin(), report.sites.end(),
      [](const auto& x, const auto& y) { return x.metrics.volume < y.metrics.volume; });
  for (int i = first; i < first + count; ++i) {
    SiteReport part = largest;
    set_forces(our.solved_site(i), part);
    largest.normal_force += part.normal_force;
    largest.force_on_A += part.force_on_A;
    largest.torque_on_A += part.torque_on_A;
  }
}

// Walks through the kept sites, which are in the order of their pairs.
class Kept {
 public:
  explicit Kept(const UserdataBlock& our) : our_(our) {}

  /// Puts the forces of the pair at a place of `near` into its report; false when none are kept.
  /// Ascending places only.
  bool take(std::size_t k, EvaluationScratch& scratch) {
    ContactReport& report = scratch.reports[k];
    const JoinedPair* joined = scratch.joined.at(k);
    if (!joined) return take(scratch.cull.near[k], report);
    // Another of its pairs may have led.
    const bool taken = std::any_of(joined->pairs.begin(), joined->pairs.end(), [&](PairId pair) {
      next_ = 0;
      return take(pair, report);
    });
    next_ = 0;
    return taken;
  }

 private:
  bool take(PairId pair, ContactReport& report) {
    while (next_ < our_.solved() && our_.solved_site(next_).pair() < pair) ++next_;
    const int first = next_;
    while (next_ < our_.solved() && our_.solved_site(next_).pair() == pair) ++next_;
    if (first == next_) return false;
    set_forces(our_, first, next_ - first, report);
    return true;
  }

  UserdataBlock our_;
  int next_ = 0;
};

}  // namespace

void keep_solved(const SceneContact& contact, const UserdataBlock& our,
                 const EvaluationScratch& scratch) {
  int count = 0;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const std::vector<SiteReport>& sites = scratch.reports[k].sites;
    if (!scratch.held[k]) continue;
    if (count + std::ssize(sites) > contact.solved_rows()) break;
    for (const SiteReport& site : sites) our.solved_site(count++).set(scratch.cull.near[k], site);
  }
  our.set_solved(count);
}

void recall_solved(const UserdataBlock& our, EvaluationScratch& scratch) {
  Kept kept(our);
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    kept.take(k, scratch);
  }
}

void hold_solved(const mjModel* m, mjData* d, const UserdataBlock& our,
                 EvaluationScratch& scratch) {
  Kept kept(our);
  scratch.stiff.clear();
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    ContactReport& report = scratch.reports[k];
    scratch.held[k] = kept.take(k, scratch) ? 1 : 0;
    const PairContact& pair = scratch.pair(k);
    for (std::size_t i = 0; i < report.sites.size(); ++i) {
      const bool stiff =
          scratch.held[k] || is_stiff(m, d, pair, report, i, ExplicitBounds::of_stage(), scratch);
      scratch.stiff.push_back(stiff ? 1 : 0);
    }
  }
}

void postpone_stiff(EvaluationScratch& scratch) {
  std::size_t site = 0;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    ContactReport& report = scratch.reports[k];
    bool is_stiff = false;
    for (std::size_t i = 0; i < report.sites.size(); ++i) {
      is_stiff = scratch.stiff[site++] != 0 || is_stiff;
    }
    if (is_stiff && !scratch.held[k]) {
      take_share(0.0, scratch.pair(k).model, report);
    }
  }
}

void add_held(const SceneContact& contact, const mjModel* m, const mjData* d,
              const UserdataBlock& our, BodyForces& forces) {
  for (int i = 0; i < our.solved(); ++i) {
    const HeldSite site = our.solved_site(i);
    const GeomPair& geoms = contact.pair(site.pair()).geoms;
    forces.add_between(m, d, geoms, site.centroid(), site.force(), site.torque());
  }
}

}  // namespace volcontact::adaptor
