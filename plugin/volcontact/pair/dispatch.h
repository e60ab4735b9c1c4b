// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <variant>

#include "volcontact/base/type_list.h"
#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/overlap_limits.h"

namespace volcontact {
namespace dispatch {

/// Whether E serves the two in either order.
template <typename E, typename A, typename B>
constexpr bool kServes = E::template serves<A, B>() || E::template serves<B, A>();

template <typename E, typename A, typename B>
bool reaches(const A& a, const B& b) noexcept {
  if constexpr (E::template serves<A, B>()) {
    return E::reaches(a, b);
  } else {
    return E::reaches(b, a);
  }
}

/// Whether E takes part where `asked` is asked for. E serves the two in one order at least.
template <typename E, typename A, typename B>
constexpr bool takes_part(Engine asked) {
  if (asked != Engine::kAuto) return asked == E::kWord || E::stands_in_for(asked);
  if constexpr (E::template serves<A, B>()) {
    return E::template in_auto<A, B>();
  } else {
    return E::template in_auto<B, A>();
  }
}

template <typename A, typename B>
constexpr bool kUnbounded = std::is_same_v<A, HalfSpace> && std::is_same_v<B, HalfSpace>;

/// Metrics made for (B, A) as those of (A, B).
inline VolumeMetrics mirrored(const VolumeMetrics& metrics_B, const Pose& X_AB) {
  return metrics_B.touching() ? reversed(transformed(metrics_B, X_AB)) : metrics_B;
}

/// `out.total` as the only site.
inline void set_one_site(Interference& out) {
  out.sites.resize(out.total.touching() ? 1 : 0);
  if (out.total.touching()) out.sites[0] = out.total;
}

inline void set_status(Status status, Interference& out) {
  out.total = VolumeMetrics{};
  out.total.status = status;
  out.sites.clear();
}

/// Whether the numbers of the sites and their sum can be those of an overlap. Each site is looked
/// at: wrong ones may cancel.
template <typename A, typename B>
bool are_possible(const A& a, const B& b, const Pose& X_AB, const Interference& out) {
  if (out.sites.empty()) return !out.total.touching() && is_finite(out.total);
  const OverlapLimits limits_a = limits_of(a), limits_b = limits_of(b);
  const auto possible = [&](const VolumeMetrics& metrics) {
    return is_possible(metrics, limits_a, limits_b, X_AB);
  };
  return possible(out.total) &&
         (out.sites.size() == 1 || std::all_of(out.sites.begin(), out.sites.end(), possible));
}

/// Of every site and of their sum; see bound_depth_moment.
template <typename A, typename B>
void bound_depth_moments(const A& a, const B& b, Interference& out) {
  const double longest = longest_line(limits_of(a), limits_of(b));
  double sum = 0.0;
  for (VolumeMetrics& site : out.sites) {
    bound_depth_moment(longest, site);
    sum += site.depth_moment;
  }
  out.total.depth_moment = sum;
}

/// A tuple of every type of some lists, once.
template <typename Tuple, typename... Lists>
struct Memory {
  using Type = Tuple;
};
template <typename... Have, typename... Lists>
struct Memory<std::tuple<Have...>, TypeList<>, Lists...> : Memory<std::tuple<Have...>, Lists...> {};
template <typename... Have, typename First, typename... More, typename... Lists>
struct Memory<std::tuple<Have...>, TypeList<First, More...>, Lists...>
    : Memory<std::conditional_t<(std::is_same_v<Have, First> || ...), std::tuple<Have...>,
                                std::tuple<Have..., First>>,
             TypeList<More...>, Lists...> {};

}  // namespace dispatch

template <typename List>
class Dispatch;

/// Asks the engines of a list in their order, and does once for all of them what is not theirs:
/// mirror images, poses that are no numbers, two unbounded solids, the way on from an engine to the
/// next, and whether what it answers can be.
template <typename... Engines>
class Dispatch<TypeList<Engines...>> {
 public:
  /// The scratch of all engines.
  using Scratch = typename dispatch::Memory<std::tuple<>, typename Engines::Scratch...>::Type;

  /// Whether an engine of this word integrates the two, in either order.
  template <typename A, typename B>
  static bool serves(Engine word, const A& a, const B& b) {
    return word == Engine::kAuto || (serves_by<Engines>(word, a, b) || ...);
  }

  /// The word of the first engine that kAuto asks; kAuto where there is none.
  template <typename A, typename B>
  static Engine first(const A& a, const B& b) {
    Engine word = Engine::kAuto;
    static_cast<void>((is_first<Engines>(a, b, word) || ...));
    return word;
  }

  /// See `interference`, which is this with the engines that there are.
  static void interference(const Shape& shape_a, const Shape& shape_b, const Pose& X_AB,
                           const InterferenceOptions& options, Scratch& scratch,
                           Interference& out) {
    std::visit(
        [&](const auto& a, const auto& b) {
          using A = std::decay_t<decltype(a)>;
          using B = std::decay_t<decltype(b)>;
          const Question<A, B> question{a, b, shape_a, shape_b, X_AB, options};
          Round<A, B>{question, scratch, out}.run();
        },
        shape_a, shape_b);
  }

 private:
  template <typename E, typename A, typename B>
  static bool serves_by(Engine word, const A& a, const B& b) {
    if constexpr (dispatch::kServes<E, A, B>) {
      return word == E::kWord && dispatch::reaches<E>(a, b);
    } else {
      return false;
    }
  }

  template <typename E, typename A, typename B>
  static bool is_first(const A& a, const B& b, Engine& word) {
    if constexpr (dispatch::kServes<E, A, B>) {
      if (dispatch::takes_part<E, A, B>(Engine::kAuto) && dispatch::reaches<E>(a, b)) {
        word = E::kWord;
        return true;
      }
    }
    return false;
  }

  // One question on its way from engine to engine.
  template <typename A, typename B>
  class Round {
   public:
    Round(const Question<A, B>& question, Scratch& scratch, Interference& out)
        : q_(question), scratch_(scratch), out_(out) {}

    void run() {
      asked_ = q_.options.engine;
      if (asked_ != Engine::kAuto && !serves(asked_, q_.a, q_.b)) asked_ = Engine::kAuto;
      if (!q_.X_AB.is_finite() || dispatch::kUnbounded<A, B>) {
        out_.engine = asked_ != Engine::kAuto ? asked_ : first(q_.a, q_.b);
        return dispatch::set_status(q_.X_AB.is_finite() ? Status::kUnbounded : Status::kInvalid,
                                    out_);
      }
      if ((settles<Engines>() || ...)) return;
      dispatch::set_status(Status::kInvalid, out_);
    }

   private:
    template <typename E>
    bool takes_part() const {
      if constexpr (dispatch::kServes<E, A, B>) {
        return (!bounds_only_ || E::kHasBounds) && dispatch::takes_part<E, A, B>(asked_) &&
               dispatch::reaches<E>(q_.a, q_.b);
      } else {
        return false;
      }
    }

    // Whether E answers, and so that no other need be asked.
    template <typename E>
    bool settles() {
      if constexpr (dispatch::kServes<E, A, B> && !dispatch::kUnbounded<A, B>) {
        if (!takes_part<E>()) return false;
        out_.engine = E::kWord;
        bounds_only_ = E::kOneSite;
        const Answer answer = ask<E>();
        if constexpr (E::kByFormula) {
          if (!std::isfinite(out_.total.volume)) return settle_no_number();
          return answer == Answer::kGiven &&
                 is_possible_volume(out_.total, limits_of(q_.a), limits_of(q_.b));
        } else {
          return answer == Answer::kGiven && accepts<E>();
        }
      } else {
        return false;
      }
    }

    template <typename E>
    bool accepts() {
      if constexpr (!E::kHasBounds && !E::kExact) {
        if (is_doubtful(out_.total, limits_of(q_.a), limits_of(q_.b))) return false;
      }
      bool possible = dispatch::are_possible(q_.a, q_.b, q_.X_AB, out_);
      if constexpr (E::kHasBounds) {
        // None is asked after it: of an overlap much smaller than its cells, V and its error are
        // left.
        if (!possible && out_.total.status != Status::kInvalid) {
          possible = keep_possible(limits_of(q_.a), limits_of(q_.b), out_.total);
          dispatch::set_one_site(out_);
        }
      }
      if constexpr (E::kExact) {
        const bool is_number = possible || is_finite(out_.total);
        if (!is_number || out_.total.status == Status::kApproximate) {
          if (another_after<E>()) return false;
          if (!is_number) return settle_no_number();
        }
      }
      if (possible) dispatch::bound_depth_moments(q_.a, q_.b, out_);
      return possible;
    }

    bool settle_no_number() {
      dispatch::set_status(Status::kInvalid, out_);
      return true;
    }

    // Whether an engine after E takes part that is no last resort.
    template <typename E>
    bool another_after() const {
      bool behind = false, found = false;
      const auto look = [&]<typename Other>(TypeTag<Other>) {
        found = found || (behind && !Other::kHasBounds && this->template takes_part<Other>());
        behind = behind || std::is_same_v<Other, E>;
      };
      (look(TypeTag<Engines>{}), ...);
      return found;
    }

    template <typename E>
    Answer ask() {
      if constexpr (E::template serves<A, B>()) {
        const Answer answer = call<E>(q_, typename E::Scratch{});
        if constexpr (E::kOneSite) dispatch::set_one_site(out_);
        return answer;
      } else {
        const Pose X_BA = q_.X_AB.inverse();
        const Question<B, A> mirror{q_.b, q_.a, q_.shape_b, q_.shape_a, X_BA, q_.options};
        const Answer answer = call<E>(mirror, typename E::Scratch{});
        if (answer == Answer::kBeyond) return answer;
        out_.total = dispatch::mirrored(out_.total, q_.X_AB);
        if constexpr (E::kOneSite) {
          dispatch::set_one_site(out_);
        } else {
          for (VolumeMetrics& site : out_.sites) site = dispatch::mirrored(site, q_.X_AB);
        }
        return answer;
      }
    }

    template <typename E, typename First, typename Second, typename... Parts>
    Answer call(const Question<First, Second>& question, TypeList<Parts...>) {
      return E::run(question, std::get<Parts>(scratch_)..., out_);
    }

    const Question<A, B>& q_;
    Scratch& scratch_;
    Interference& out_;
    Engine asked_ = Engine::kAuto;
    bool bounds_only_ = false;
  };
};

}  // namespace volcontact
