// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "volcontact/base/type_list.h"
#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/overlap_limits.h"

namespace volcontact {
namespace dispatch {

/// Makes metrics of (B, A) those of (A, B).
inline void mirror(const Pose& X_AB, VolumeMetrics& metrics) {
  if (!metrics.touching()) return;
  transform(X_AB, metrics);
  reverse(metrics);
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
inline bool are_possible(const OverlapLimits& a, const OverlapLimits& b, const Pose& X_AB,
                         const Interference& out) {
  if (out.sites.empty()) return !out.total.touching() && is_finite(out.total);
  const auto possible = [&](const VolumeMetrics& metrics) {
    return is_possible(metrics, a, b, X_AB);
  };
  return possible(out.total) &&
         (out.sites.size() == 1 || std::all_of(out.sites.begin(), out.sites.end(), possible));
}

/// Of every site and of their sum; see bound_depth_moment.
inline void bound_depth_moments(const OverlapLimits& a, const OverlapLimits& b, Interference& out) {
  const double longest = longest_square(a, b);
  double sum = 0.0;
  for (VolumeMetrics& site : out.sites) {
    bound_depth_moment(longest, site);
    sum += site.depth_moment;
  }
  out.total.depth_moment = sum;
}

inline OverlapLimits limits_of_shape(const Shape& shape) {
  return std::visit([](const auto& solid) { return limits_of(solid); }, shape);
}

/// What is asked, of solids of any types.
struct Asked {
  const Shape& a;
  const Shape& b;
  const Pose& X_AB;
  const InterferenceOptions& options;
};

/// One engine and two types of solids that it serves: all that the way from engine to engine needs
/// to know. The functions take the solids in the order that the engine serves.
template <typename Scratch>
struct Service {
  Engine word = Engine::kAuto;
  unsigned asked_as = 0;   ///< bit i: takes part where the engine number i is asked for
  bool is_mirror = false;  ///< the engine serves the two in the other order
  bool by_formula = false, one_site = false, exact = false;  ///< see EngineBase
  bool some_poses = false, has_bounds = false;
  bool (*reaches)(const Shape& a, const Shape& b) = nullptr;  ///< null: all solids of these types
  Answer (*run)(const Asked& asked, Scratch& scratch, Interference& out) = nullptr;

  bool takes_part(Engine asked, const Shape& a, const Shape& b) const {
    if (!(asked_as >> static_cast<unsigned>(asked) & 1u)) return false;
    return !reaches || (is_mirror ? reaches(b, a) : reaches(a, b));
  }
};

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

/// Of the dispatcher D, all services for A and B in the order of its engines.
template <typename D, typename A, typename B>
inline constexpr auto kServices = D::template services<A, B>();

}  // namespace dispatch

template <typename List>
class Dispatch;

/// Asks the engines of a list in their order, and does once for all of them what is not theirs:
/// mirror images, poses that are no numbers, two unbounded solids, the way on from an engine to the
/// next, and whether what it answers can be. What depends on the types of the solids is in tables,
/// one for each two types.
template <typename... Engines>
class Dispatch<TypeList<Engines...>> {
 public:
  /// The scratch of all engines.
  using Scratch = typename dispatch::Memory<std::tuple<>, typename Engines::Scratch...>::Type;

  /// Whether an engine of this word integrates the two, in either order.
  static bool serves(Engine word, const Shape& a, const Shape& b) {
    if (word == Engine::kAuto) return true;
    const Services services = services_of(a, b);
    return std::any_of(services.begin(), services.end(), [&](const Service& service) {
      return service.word == word && service.takes_part(word, a, b);
    });
  }

  /// The word of the first engine that kAuto asks at any pose; kAuto where there is none.
  static Engine first(const Shape& a, const Shape& b) {
    for (const Service& service : services_of(a, b)) {
      if (!service.some_poses && service.takes_part(Engine::kAuto, a, b)) return service.word;
    }
    return Engine::kAuto;
  }

  /// See `interference`, which is this with the engines that there are.
  static void interference(const Shape& a, const Shape& b, const Pose& X_AB,
                           const InterferenceOptions& options, Scratch& scratch,
                           Interference& out) {
    Round{{a, b, X_AB, options}, services_of(a, b), scratch, out}.run();
  }

  using Service = dispatch::Service<Scratch>;

  /// All that serve A and B in either order.
  template <typename A, typename B>
  static constexpr auto services() {
    std::array<Service, (std::size_t{kServes<Engines, A, B>} + ... + 0)> table;
    std::size_t i = 0;
    const auto add = [&]<typename E>(TypeTag<E>) {
      if constexpr (E::template serves<A, B>()) {
        table[i++] = service<E, A, B>(false);
      } else if constexpr (E::template serves<B, A>()) {
        table[i++] = service<E, B, A>(true);
      }
    };
    (add(TypeTag<Engines>{}), ...);
    return table;
  }

 private:
  using Services = std::span<const Service>;

  template <typename E, typename A, typename B>
  static constexpr bool kServes = E::template serves<A, B>() || E::template serves<B, A>();
  template <typename A, typename B>
  static constexpr bool kUnbounded = std::is_same_v<A, HalfSpace> && std::is_same_v<B, HalfSpace>;

  // Whether E looks at the types of solids alone.
  template <typename E, typename A, typename B>
  static constexpr bool kReachesAll =
      std::is_same_v<decltype(E::reaches(std::declval<const A&>(), std::declval<const B&>())),
                     std::true_type>;

  static Services services_of(const Shape& a, const Shape& b) {
    static constexpr auto kTables = tables(Shapes{});
    return kTables[a.index()][b.index()];
  }
  template <typename... As>
  static constexpr auto tables(TypeList<As...> shapes) {
    return std::array{tables_with<As>(shapes)...};
  }
  template <typename A, typename... Bs>
  static constexpr auto tables_with(TypeList<Bs...>) {
    return std::array{Services(dispatch::kServices<Dispatch, A, Bs>)...};
  }

  template <typename E, typename A, typename B>
  static constexpr Service service(bool is_mirror) {
    Service service{.word = E::kWord,
                    .is_mirror = is_mirror,
                    .by_formula = E::kByFormula,
                    .one_site = E::kOneSite,
                    .exact = E::kExact,
                    .some_poses = E::kSomePoses,
                    .has_bounds = E::kHasBounds};
    for (const Engine asked : kEngines) {
      if (takes_part<E, A, B>(asked)) service.asked_as |= 1u << static_cast<unsigned>(asked);
    }
    if constexpr (!kReachesAll<E, A, B>) service.reaches = reaches<E, A, B>;
    if constexpr (!kUnbounded<A, B>) service.run = run<E, A, B>;
    return service;
  }
  template <typename E, typename A, typename B>
  static constexpr bool takes_part(Engine asked) {
    if (asked != Engine::kAuto) {
      return !E::kSomePoses && (asked == E::kWord || E::stands_in_for(asked));
    }
    return E::template in_auto<A, B>();
  }

  // Compiled once for two types of solids, whichever of them is A.
  template <typename E, typename A, typename B>
  static bool reaches(const Shape& a, const Shape& b) {
    return E::reaches(*std::get_if<A>(&a), *std::get_if<B>(&b));
  }
  template <typename E, typename A, typename B>
  static Answer run(const dispatch::Asked& asked, Scratch& scratch, Interference& out) {
    const A& a = *std::get_if<A>(&asked.a);
    const B& b = *std::get_if<B>(&asked.b);
    const Question<A, B> question{a, b, asked.a, asked.b, asked.X_AB, asked.options};
    const Answer answer = call<E>(question, scratch, out, typename E::Scratch{});
    if constexpr (E::kByFormula) {
      const bool is_number = std::isfinite(out.total.volume);
      const bool possible = !is_number || is_possible_volume(out.total, limits_of(a), limits_of(b));
      return possible ? answer : Answer::kBeyond;
    }
    return answer;
  }
  template <typename E, typename A, typename B, typename... Parts>
  static Answer call(const Question<A, B>& question, Scratch& scratch, Interference& out,
                     TypeList<Parts...>) {
    return E::run(question, std::get<Parts>(scratch)..., out);
  }

  // One question on its way from engine to engine.
  class Round {
   public:
    Round(const dispatch::Asked& asked, Services services, Scratch& scratch, Interference& out)
        : q_(asked), services_(services), scratch_(scratch), out_(out) {}

    void run() {
      word_ = q_.options.engine;
      if (word_ != Engine::kAuto && !serves(word_, q_.a, q_.b)) word_ = Engine::kAuto;
      const bool unbounded =
          std::holds_alternative<HalfSpace>(q_.a) && std::holds_alternative<HalfSpace>(q_.b);
      if (unbounded || !q_.X_AB.is_finite()) {
        out_.engine = word_ != Engine::kAuto ? word_ : first(q_.a, q_.b);
        const Status status = q_.X_AB.is_finite() ? Status::kUnbounded : Status::kInvalid;
        return dispatch::set_status(status, out_);
      }
      for (const Service& service : services_) {
        if (takes_part(service) && settles(service)) return;
      }
      dispatch::set_status(Status::kInvalid, out_);
    }

   private:
    bool takes_part(const Service& service) const {
      return (!bounds_only_ || service.has_bounds) && service.takes_part(word_, q_.a, q_.b);
    }

    // Whether it answers, and so that no other need be asked.
    bool settles(const Service& service) {
      out_.engine = service.word;
      bounds_only_ = service.one_site;
      const Answer answer = ask(service);
      if (service.by_formula && !std::isfinite(out_.total.volume)) return settle_no_number();
      if (answer == Answer::kBeyond) return false;
      return service.by_formula || accepts(service);
    }

    Answer ask(const Service& service) {
      if (!service.is_mirror) {
        const Answer answer = service.run(q_, scratch_, out_);
        if (service.one_site) dispatch::set_one_site(out_);
        return answer;
      }
      const Pose X_BA = q_.X_AB.inverse();
      const Answer answer = service.run({q_.b, q_.a, X_BA, q_.options}, scratch_, out_);
      if (answer == Answer::kBeyond) return answer;
      dispatch::mirror(q_.X_AB, out_.total);
      if (service.one_site) {
        dispatch::set_one_site(out_);
      } else {
        for (VolumeMetrics& site : out_.sites) dispatch::mirror(q_.X_AB, site);
      }
      return answer;
    }

    bool accepts(const Service& service) {
      if (is_none()) return true;
      const OverlapLimits a = dispatch::limits_of_shape(q_.a);
      const OverlapLimits b = dispatch::limits_of_shape(q_.b);
      if (!service.has_bounds && !service.exact && is_doubtful(out_.total, a, b)) return false;
      bool possible = dispatch::are_possible(a, b, q_.X_AB, out_);
      if (service.has_bounds && !possible && out_.total.status != Status::kInvalid) {
        // None is asked after it: of an overlap much smaller than its cells, V and its error are
        // left.
        possible = keep_possible(a, b, out_.total);
        dispatch::set_one_site(out_);
      }
      if (service.exact) {
        const bool is_number = possible || is_finite(out_.total);
        if (!is_number || out_.total.status == Status::kApproximate) {
          if (another_after(service)) return false;
          if (!is_number) return settle_no_number();
        }
      }
      if (possible) dispatch::bound_depth_moments(a, b, out_);
      return possible;
    }

    // The most frequent answer, in which there is nothing to doubt.
    bool is_none() {
      VolumeMetrics& m = out_.total;
      if (!out_.sites.empty() || m.touching() || m.status != Status::kOk) return false;
      if (m.volume_error != 0.0 || !is_finite(m)) return false;
      m.depth_moment = 0.0;
      return true;
    }

    bool settle_no_number() {
      dispatch::set_status(Status::kInvalid, out_);
      return true;
    }

    // Whether an engine after this one takes part that is no last resort.
    bool another_after(const Service& service) const {
      const Service* const end = services_.data() + services_.size();
      return std::any_of(&service + 1, end, [&](const Service& other) {
        return !other.has_bounds && takes_part(other);
      });
    }

    const dispatch::Asked q_;
    const Services services_;
    Scratch& scratch_;
    Interference& out_;
    Engine word_ = Engine::kAuto;  // asked for
    bool bounds_only_ = false;
  };
};

}  // namespace volcontact
