// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace volcontact::adaptor {

/// Whether the pairs of an evaluation are shared among threads, from how long it took either way:
/// on a machine whose cores are busy, threads wait for each other. No value depends on it.
class ThreadChoice {
 public:
  /// The time of one thread from which sharing may gain more than it costs [s].
  static constexpr double kWorthSharing = 200e-6;

  /// For an evaluation of so many pairs, with `most` threads to be had: whether to share them.
  bool shares(int most, std::size_t pairs) noexcept {
    pairs_ = pairs;
    if (most < 2 || pairs == 0) return is_shared_ = false;
    if (tries_left_ > 0) return is_shared_;  // goes on to try what it tried before
    if (!alone_.is_known) return begin_try(false);
    if (alone_.per_pair * static_cast<double>(pairs) < kWorthSharing) return is_shared_ = false;
    if (!shared_.is_known) return begin_try(true);
    const bool is_better = shared_.per_pair < kLeastGain * alone_.per_pair;
    if (++since_try_ > kTryAgain) return begin_try(!is_better);
    return is_shared_ = is_better;
  }

  /// Whether to say how long it takes: where one thread will do by far, now and then.
  bool wants_time() noexcept {
    const bool is_plain = tries_left_ == 0 && !is_shared_ &&
                          alone_.per_pair * static_cast<double>(pairs_) < 0.5 * kWorthSharing;
    return !is_plain || ++since_time_ % kTimedOf == 0;
  }

  /// How long that evaluation took [s], if it wants to know.
  void took(double seconds) noexcept {
    if (pairs_ == 0) return;
    Way& way = is_shared_ ? shared_ : alone_;
    const double now = seconds / static_cast<double>(pairs_);
    if (tries_left_ > 0) {  // the best of some: the first ones find cold memory and threads asleep
      tried_ = tries_left_ == kTries ? now : std::min(tried_, now);
      if (--tries_left_ == 0) way = {tried_, true};
    } else if (way.is_known) {  // an interruption counts little, a change that lasts counts
      way.per_pair +=
          kWeight * (std::clamp(now, 0.5 * way.per_pair, 2.0 * way.per_pair) - way.per_pair);
    }
  }

 private:
  struct Way {
    double per_pair = 0.0;  // [s]
    bool is_known = false;
  };
  static constexpr double kLeastGain = 0.9, kWeight = 0.1;
  static constexpr int kTries = 3, kTryAgain = 1000;
  static constexpr unsigned kTimedOf = 16;

  bool begin_try(bool shared) noexcept {
    tries_left_ = kTries;
    since_try_ = 0;
    return is_shared_ = shared;
  }

  Way alone_, shared_;
  bool is_shared_ = false;
  std::size_t pairs_ = 0;
  int tries_left_ = 0, since_try_ = 0;
  unsigned since_time_ = 0;
  double tried_ = 0.0;
};

/// The choices of the scenes that a thread evaluated last.
class ThreadChoices {
 public:
  ThreadChoice& of(const void* scene) noexcept {
    for (Entry& entry : entries_) {
      if (entry.scene == scene) return entry.choice;
    }
    Entry& oldest = entries_[next_];
    next_ = (next_ + 1) % entries_.size();
    oldest = {scene, {}};
    return oldest.choice;
  }

 private:
  struct Entry {
    const void* scene = nullptr;
    ThreadChoice choice;
  };
  std::array<Entry, 8> entries_;
  std::size_t next_ = 0;
};

}  // namespace volcontact::adaptor
