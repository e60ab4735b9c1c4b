// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>

#include "adaptor/scene/pair_contact.h"

namespace volcontact::adaptor {

/// The contact models of the pairs of a scene, each made when it is first asked for: of a thousand
/// geoms, few pairs ever come near each other. Any number of threads may ask.
class PairStore {
 public:
  explicit PairStore(std::size_t pairs)
      : made_(std::make_unique<std::atomic<const PairContact*>[]>(pairs)) {}

  /// The pair with this number, from `make()` where there is none yet.
  template <typename Make>
  const PairContact& get(std::size_t pair, Make&& make) const {
    if (const PairContact* known = made_[pair].load(std::memory_order_acquire)) return *known;
    const std::lock_guard lock(mutex_);
    if (const PairContact* known = made_[pair].load(std::memory_order_relaxed)) return *known;
    all_.push_back(make());
    made_[pair].store(&all_.back(), std::memory_order_release);
    return all_.back();
  }

  /// How many were asked for.
  std::size_t made() const {
    const std::lock_guard lock(mutex_);
    return all_.size();
  }

 private:
  std::unique_ptr<std::atomic<const PairContact*>[]> made_;
  mutable std::mutex mutex_;
  mutable std::deque<PairContact> all_;
};

}  // namespace volcontact::adaptor
