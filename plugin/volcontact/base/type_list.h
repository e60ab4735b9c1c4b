// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <variant>

namespace volcontact {

/// A list of types: the one place where shapes, or laws, are enumerated.
template <typename... Ts>
struct TypeList {
  static constexpr std::size_t kSize = sizeof...(Ts);
  using Variant = std::variant<Ts...>;
  /// The list with more types at its end.
  template <typename... More>
  using With = TypeList<Ts..., More...>;
};

/// Names a type without making a value of it.
template <typename T>
struct TypeTag {
  using Type = T;
};

/// Calls visit(TypeTag<T>{}) for every T of the list, in order.
template <typename... Ts, typename Visitor>
void for_each_type(TypeList<Ts...>, Visitor&& visit) {
  (visit(TypeTag<Ts>{}), ...);
}

}  // namespace volcontact
