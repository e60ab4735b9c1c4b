// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "volcontact/base/thread_team.h"

namespace volcontact {

/// Sum of term(i) over i in [0, count), the same to the last bit for any team: blocks
/// of `grain` terms are added in index order, then the blocks in index order. `partial` is scratch.
/// T is zero when value-initialised and has +=.
template <typename T, typename Term>
T ordered_sum(ThreadTeam& team, int count, int grain, std::vector<T>& partial, Term&& term) {
  const int blocks = (count + grain - 1) / grain;
  partial.resize(std::max<std::size_t>(partial.size(), blocks));
  team.for_each(blocks, 1, [&](int block) {
    const int last = std::min(count, (block + 1) * grain);
    T sum{};
    for (int i = block * grain; i < last; ++i) sum += term(i);
    partial[block] = sum;
  });
  T total{};
  for (int block = 0; block < blocks; ++block) total += partial[block];
  return total;
}

}  // namespace volcontact
