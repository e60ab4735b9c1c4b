// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace volcontact {

/// How a number that a law keeps follows its contact site from one evaluation to the next, when the
/// contact plane turns and when sites split and merge. docs/theory.md, "Memory of a site".
enum class Keeping : int {
  kVector = 0,  ///< three numbers, a vector in the contact plane: turned with it, else as an amount
  kAmount = 1,  ///< shared among the sites that came of one; the sum where sites became one
  kValue = 2,   ///< the same for all that came of one; the mean by volume where sites became one
  kVectorValue =
      3,  ///< three numbers, a vector in the contact plane: turned with it, else as a value
};

/// One row of a law's table `kStates`: what the law keeps for each contact site. An internal
/// parameter (the speed at impact) is a state that the law sets once instead of integrating it.
struct StateField {
  const char* name;
  const char* unit;  ///< SI, "-" for none
  Keeping keeping;
  const char* meaning;

  constexpr int size() const {
    return keeping == Keeping::kVector || keeping == Keeping::kVectorValue ? 3 : 1;
  }
};

/// Numbers that a law with this table keeps for each contact site.
constexpr int size_of(std::span<const StateField> states) {
  int size = 0;
  for (const StateField& state : states) size += state.size();
  return size;
}

/// What a law keeps from one evaluation to the next, for one contact site. The arrays belong to the
/// caller and have the numbers of the law's kStates, vectors in the world frame.
///
/// A law reads `committed`, the values `elapsed` seconds ago, and writes to `pending` those of now.
/// It may be called any number of times for one step (Runge-Kutta stages, finite differences): the
/// caller commits when time has moved on. A site that just began has all zeros in `committed`.
struct LawState {
  const double* committed = nullptr;
  double* pending = nullptr;
  double elapsed = 0.0;  ///< [s], >= 0
};

}  // namespace volcontact
