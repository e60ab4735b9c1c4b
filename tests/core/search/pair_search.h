// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/search/search_cases.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test {

/// Something that is wrong with an answer, and all that is needed to see it again.
struct SearchFailure {
  std::string what;
  Engine engine;
  Status status;
  std::string a, b, X_AB;  ///< Python expressions
  double volume = 0.0, volume_error = 0.0;
  double expected = 0.0, doubt = 0.0;  ///< of the judge
};

/// One case and what came of it.
struct SearchOutcome {
  SearchFamily family;
  Engine engine = Engine::kAuto;
  bool overlapping = false;
  bool undecided = false;
  int level = -1;             ///< of the judge when it agreed; -1 where it was not asked
  double error = 0.0;         ///< of V, by V, where the judge agreed or not [-]
  double doubt = 0.0;         ///< of the judge, by V [-]
  double seconds = 0.0;       ///< of the slower of the two orders
  std::uint64_t answers = 0;  ///< a hash of all bits of all answers
  std::vector<SearchFailure> failures;
};

/// Evaluates the case in both orders and judges it: numbers that are finite, V within both volumes,
/// sites that add up, both orders alike, a centroid inside, V and its error against the lines, the
/// centroid and the area vector likewise, and for some a small motion whose increments of V must
/// fit S and T. `level` is that of the judge's first look.
class PairSearch {
 public:
  SearchOutcome run(const SearchCase& c, int level, std::uint64_t seed);
  /// Asks all that run() asks and judges nothing: where `answers` is the same on other engines, so
  /// is their judgement.
  SearchOutcome ask(const SearchCase& c, std::uint64_t seed);

 private:
  InterferenceWorkspace workspace_;
  Interference result_, mirrored_;
};

}  // namespace volcontact::test
