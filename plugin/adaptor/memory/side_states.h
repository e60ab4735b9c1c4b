// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace volcontact::adaptor {

/// State beside mjData, of scenes whose userdata has no room: a block of numbers per address of an
/// mjData. It knows nothing of copies and resets, so nothing that lasts in mjData may depend on it:
/// forces go to qfrc_passive. A block lives as long as the scene, since no one says when an mjData
/// ends; addresses come again, so there are about as many as there ever were data at a time.
class SideStates {
 public:
  /// One past the last number of the block of `d`, which has at least `size`; zeros at first. Where
  /// it grows, the last numbers stay. For several threads with data of their own.
  double* end_of(const mjData* d, int size) {
    const std::lock_guard lock(mutex_);
    std::vector<double>& block = blocks_[d];
    if (block.size() < static_cast<std::size_t>(size)) {
      block.insert(block.begin(), static_cast<std::size_t>(size) - block.size(), 0.0);
    }
    return block.data() + block.size();
  }

 private:
  std::mutex mutex_;
  std::unordered_map<const mjData*, std::vector<double>> blocks_;
};

}  // namespace volcontact::adaptor
