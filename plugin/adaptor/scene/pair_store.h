// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "adaptor/scene/pair_contact.h"

namespace volcontact::adaptor {

/// The contact models of the pairs of a scene, each made when it is first asked for: of a thousand
/// geoms, few pairs ever come near each other. Memory goes with those. Any number of threads may
/// ask.
class PairStore {
 public:
  PairStore() { grow(); }

  /// The pair with this number, from `make()` where there is none yet.
  template <typename Make>
  const PairContact& get(PairId pair, Make&& make) const {
    if (const PairContact* known = present_.load(std::memory_order_acquire)->find(pair)) {
      return *known;
    }
    const std::lock_guard lock(mutex_);
    if (const PairContact* known = tables_.back()->find(pair)) return *known;
    all_.push_back({pair, make()});
    if (2 * all_.size() > tables_.back()->size()) {
      grow();
    } else {
      tables_.back()->add(all_.back());
    }
    return all_.back().contact;
  }

  /// How many were asked for.
  std::size_t made() const {
    const std::lock_guard lock(mutex_);
    return all_.size();
  }

 private:
  struct Entry {
    PairId pair;
    PairContact contact;
  };

  // Open addressing, never more than half full; entries are added only.
  class Table {
   public:
    explicit Table(std::size_t size)
        : mask_(size - 1), slots_(std::make_unique<std::atomic<const Entry*>[]>(size)) {}
    std::size_t size() const { return mask_ + 1; }
    const PairContact* find(PairId pair) const {
      for (std::size_t i = first(pair);; ++i) {
        const Entry* entry = slots_[i & mask_].load(std::memory_order_acquire);
        if (!entry) return nullptr;
        if (entry->pair == pair) return &entry->contact;
      }
    }
    void add(const Entry& entry) {
      std::size_t i = first(entry.pair);
      while (slots_[i & mask_].load(std::memory_order_relaxed)) ++i;
      slots_[i & mask_].store(&entry, std::memory_order_release);
    }

   private:
    static std::size_t first(PairId pair) {
      const auto mixed = static_cast<std::uint64_t>(pair) * 0x9e3779b97f4a7c15u;
      return static_cast<std::size_t>(mixed >> 32);
    }
    std::size_t mask_;
    std::unique_ptr<std::atomic<const Entry*>[]> slots_;
  };

  // Tables of before stay: a thread may be reading them. Together they are no larger than the last.
  void grow() const {
    constexpr std::size_t kLeast = 64;
    auto larger = std::make_unique<Table>(tables_.empty() ? kLeast : 2 * tables_.back()->size());
    for (const Entry& entry : all_) larger->add(entry);
    tables_.push_back(std::move(larger));
    present_.store(tables_.back().get(), std::memory_order_release);
  }

  mutable std::mutex mutex_;
  mutable std::deque<Entry> all_;
  mutable std::vector<std::unique_ptr<Table>> tables_;
  mutable std::atomic<const Table*> present_{nullptr};
};

}  // namespace volcontact::adaptor
