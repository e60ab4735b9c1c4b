// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "volcontact/model/site_memory.h"

namespace volcontact::adaptor {

/// How many rows of what size a scene keeps its contact sites in.
struct SitePoolLayout {
  int rows = 0;
  int row_size = 0;  ///< of the contact model with the largest rows

  int stride() const { return 1 + row_size; }
  int size() const { return rows > 0 ? 1 + rows * stride() : 0; }
};

/// The contact sites of one evaluation, in the states of its slot: their number, then a row each,
/// the number of the pair before what its contact model keeps. In ascending order of pairs.
template <typename Number>
class SitePool {
 public:
  SitePool(Number* numbers, const SitePoolLayout& layout) : p_(numbers), layout_(layout) {}

  int count() const { return layout_.rows > 0 ? static_cast<int>(p_[0]) : 0; }

  void clear() const {
    if (layout_.rows > 0) p_[0] = 0.0;
  }

  /// Appends a row of `size` numbers; false when there is no room.
  bool push(std::int64_t pair, const double* row, int size) const {
    const int n = count();
    if (n >= layout_.rows) return false;
    Number* to = row_at(n);
    to[0] = static_cast<double>(pair);
    std::fill(std::copy_n(row, size, to + 1), to + layout_.stride(), 0.0);
    p_[0] = n + 1;
    return true;
  }

  /// Appends a row of a pair as it was; false when there is no room.
  bool copy(const SitePool<const double>& before, std::int64_t pair, std::size_t row) const {
    const SiteMemory rows = before.rows_of(pair, 0.0);
    return push(pair, rows.rows + static_cast<std::ptrdiff_t>(row) * rows.stride, rows.stride - 1);
  }

  /// The rows of one pair, as its contact model wants them.
  SiteMemory rows_of(std::int64_t number, double elapsed) const {
    const auto pair = static_cast<double>(number);
    int first = 0;
    for (int length = count(); length > 0;) {  // lower bound
      const int half = length / 2;
      if (row_at(first + half)[0] < pair) {
        first += half + 1;
        length -= half + 1;
      } else {
        length = half;
      }
    }
    int last = first;
    while (last < count() && row_at(last)[0] == pair) ++last;
    return {row_at(first) + 1, last - first, layout_.stride(), elapsed};
  }

 private:
  Number* row_at(int i) const { return p_ + 1 + static_cast<std::ptrdiff_t>(i) * layout_.stride(); }

  Number* p_;
  SitePoolLayout layout_;
};

}  // namespace volcontact::adaptor
