// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

namespace volcontact {

/// Calls task(i) once for every i in [0, count), in any order, on up to `threads` threads of which
/// each takes `grain` tasks at a time. The tasks must not depend on each other.
template <typename Task>
void for_each_task(int count, int threads, int grain, Task&& task) {
  if (threads <= 1 || count <= grain) {
    for (int i = 0; i < count; ++i) task(i);
    return;
  }
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (int first = 0; first < count; first += grain) {
    const int last = std::min(count, first + grain);
    for (int i = first; i < last; ++i) task(i);
  }
}

/// Sum of term(i) over i in [0, count), the same to the last bit for any number of threads: blocks
/// of `grain` terms are added in index order, then the blocks in index order. `partial` is scratch.
/// T is zero when value-initialised and has +=.
template <typename T, typename Term>
T ordered_sum(int count, int threads, int grain, std::vector<T>& partial, Term&& term) {
  const int blocks = (count + grain - 1) / grain;
  partial.resize(std::max<std::size_t>(partial.size(), blocks));
  for_each_task(blocks, threads, 1, [&](int block) {
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
