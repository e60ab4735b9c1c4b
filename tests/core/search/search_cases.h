// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/search/search_solids.h"
#include "core/support/random.h"

namespace volcontact::test {

/// What the random search draws its pairs from.
enum class SearchFamily : int {
  kRandom = 0,    ///< simple solids at random, from deep to 1e-6 of the size
  kSpecial = 1,   ///< the same parallel, coaxial, flush, tangent, concentric, rims meeting
  kCones = 2,     ///< frusta with sharp tips, and what meets their rims
  kThin = 3,      ///< one size of 1e-4 to 0.1 of the others
  kBored = 4,     ///< blocks, pipes and cups with what fits into them
  kComposed = 5,  ///< random trees of operations to depth 4
  kMeshes = 6,    ///< meshes of polyhedra with simple solids and with each other
  kSlender = 7,   ///< the same meshes with simple solids of which one size is 0.02 to 0.3
};
inline constexpr std::array kSearchFamilies = {
    SearchFamily::kRandom, SearchFamily::kSpecial,  SearchFamily::kCones,  SearchFamily::kThin,
    SearchFamily::kBored,  SearchFamily::kComposed, SearchFamily::kMeshes, SearchFamily::kSlender};
const char* to_string(SearchFamily family);

struct SearchCase {
  SearchFamily family = SearchFamily::kRandom;
  SearchSolid a, b;
  Pose X_AB;
  bool special = false;  ///< features meet: faces may be shared, where S is a convention
};

/// The cases of a family by number, the same on every machine. Composed solids take long to
/// prepare: twenty poses in a row have the same two.
class SearchCases {
 public:
  SearchCases(SearchFamily family, std::uint64_t seed) : family_(family), seed_(seed) {}
  /// Throws std::invalid_argument where the numbers drawn make no solid.
  SearchCase operator[](std::uint64_t index);

 private:
  SearchFamily family_;
  std::uint64_t seed_;
  std::uint64_t group_ = ~std::uint64_t{0};
  SearchCase pair_;
};

}  // namespace volcontact::test
