// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace volcontact {

/// What a search made of the leaves of a tree that it met last. Pairs of leaves come in an order in
/// which either leaf comes again and again.
template <typename Leaf>
class LeafCache {
 public:
  LeafCache() { std::fill(number_, number_ + kSize, -1); }

  /// The leaf of that number; make(leaf) fills it where it is not at hand.
  template <typename Make>
  [[gnu::always_inline]] inline Leaf& at(int number, Make&& make) {
    const int place = number % kSize;  // neighbours in space have numbers near to each other
    if (number_[place] != number) {
      number_[place] = number;
      make(leaf_[place]);
    }
    return leaf_[place];
  }

 private:
  static constexpr int kSize = 32;
  int number_[kSize];
  Leaf leaf_[kSize];
};

}  // namespace volcontact
