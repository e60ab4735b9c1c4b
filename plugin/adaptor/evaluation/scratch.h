// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "adaptor/evaluation/body_forces.h"
#include "adaptor/evaluation/joined_pairs.h"
#include "adaptor/evaluation/mocap_motion.h"
#include "adaptor/evaluation/thread_choice.h"
#include "adaptor/geoms/cull.h"
#include "adaptor/memory/site_pool.h"
#include "adaptor/step/native_constraints.h"
#include "volcontact/model/contact_model.h"
#include "volcontact/step/implicit_step.h"
#include "volcontact/step/work_limit.h"

namespace volcontact::adaptor {

/// Memory of one evaluation; one per thread, reused from call to call.
struct EvaluationScratch {
  Cull::Scratch cull;                        ///< `near`: the pairs evaluated
  std::vector<const PairContact*> contacts;  ///< their contact models
  std::vector<PairId> asleep;  ///< pairs near each other of which no side is awake, ascending
  std::vector<int> trees;      ///< sets of trees that touch
  JoinedPairs joined;          ///< those of them that stand for several
  std::vector<ContactReport> reports;  ///< of the pairs in `near`, finite numbers only
  std::vector<char> invalid;           ///< whether a report was left out, having no numbers
  std::vector<char> stiff;             ///< of all sites, whether an explicit step cannot hold it
  std::vector<char> foreseen;  ///< of the pairs in `near`, whether the work of the step is foreseen
  /// Of the pairs in `near`, the inverse mass that their normal forces act on, as far as it was
  /// foreseen and matters; or 0 [1/kg].
  std::vector<double> yields;
  bool knows = false;      ///< whether `known` is of this evaluation
  std::vector<char> held;  ///< of the pairs in `near`, whether other forces than its laws say act
  std::vector<int> order;  ///< of `near`, as worked off: the long pairs first
  std::vector<ContactModel::Workspace> workspaces;  ///< one per OpenMP thread
  ThreadChoices choices;
  BodyForces forces;
  ImplicitStep implicit;
  StepMetric metric;                 ///< and what it takes in: what MuJoCo does implicitly,
  NativeConstraints constraints;     ///< and its constraints
  std::vector<PairEnergy> energies;  ///< of the pairs in `near`
  std::vector<PairEnergy::Now> now;  ///< and their sites as the laws say, together
  std::vector<WorkLimit> limits;     ///< and what they may do in the step: `limit_of`
  double put_in = 0.0;               ///< by the step that ends here, as these tell it [J]
  std::vector<double> user_qfrc, user_xfrc, known, row;
  std::vector<double> on_bodies;  ///< forces and torques at their centres of mass
  MocapMotion mocaps;
  std::vector<double> way;  ///< of the dofs since the evaluation before
  /// What is kept, by the pair under which it is found again: pair, place in `near`, number.
  std::vector<std::tuple<PairId, std::size_t, std::size_t>> kept;

  /// The pair to which a site of the pair at place k of `near` belongs: of flush solids, that in
  /// which its centroid lies.
  PairId pair_of_site(std::size_t k, std::size_t site) const {
    return joined.pair_of_site(cull.near, k, site);
  }
  const GeomPair& geoms_of_site(const SceneContact& contact, std::size_t k,
                                std::size_t site) const {
    return joined.at(k) ? contact.pair(pair_of_site(k, site)).geoms : pair(k).geoms;
  }

  /// In place of a place in `near`, for rows that are kept as they were.
  static constexpr auto kAsleep = static_cast<std::size_t>(-1);
  /// Adds the rows of the pairs that sleep to what is kept.
  void keep_asleep(const SitePool<const double>& before) {
    for (const PairId pair : asleep) {
      const auto rows = static_cast<std::size_t>(before.rows_of(pair, 0.0).count);
      for (std::size_t i = 0; i < rows; ++i) kept.emplace_back(pair, kAsleep, i);
    }
  }
  void sort_kept() {
    if (!joined.empty() || !asleep.empty()) std::sort(kept.begin(), kept.end());
  }

  /// The pair at place k of `near`.
  const PairContact& pair(std::size_t k) const { return *contacts[k]; }
};

}  // namespace volcontact::adaptor
