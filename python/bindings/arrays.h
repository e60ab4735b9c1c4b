// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <optional>

#include "volcontact/base/types.h"

namespace volcontact::python {

/// Arrays of Python, of which only the numbers are read.
template <typename T, typename... Shape>
using Numbers = nanobind::ndarray<const T, nanobind::numpy, Shape..., nanobind::c_contig>;
using Rows = Numbers<double, nanobind::ndim<2>>;
using RowsOfThree = Numbers<double, nanobind::shape<-1, 3>>;

/// A new array of Python, whose numbers `fill` writes.
template <typename T, typename... Shape, typename Fill>
nanobind::ndarray<T, nanobind::numpy, Shape..., nanobind::c_contig> new_array(
    std::initializer_list<std::size_t> shape, const Fill& fill) {
  std::size_t count = 1;
  for (const std::size_t side : shape) count *= side;
  T* const numbers = new T[std::max<std::size_t>(count, 1)];
  const nanobind::capsule owner(numbers, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  fill(numbers);
  return {numbers, shape, owner};
}

}  // namespace volcontact::python

// Vectors and matrices are arrays in Python, copied.
namespace nanobind::detail {

template <int N>
struct type_caster<volcontact::Vector<N>> {
  using Shape = nanobind::shape<N>;
  NB_TYPE_CASTER(volcontact::Vector<N>,
                 (make_caster<ndarray<double, numpy, Shape, c_contig>>::Name))

  template <typename Flags>
  bool from_python(handle source, Flags flags, cleanup_list* cleanup) noexcept {
    make_caster<volcontact::python::Numbers<double, Shape>> array;
    const auto some = static_cast<Flags>(flags & ~static_cast<Flags>(cast_flags::accepts_none));
    if (!array.from_python(source, some, cleanup)) return false;
    value = volcontact::Vector<N>::from(array.value.data());
    return true;
  }
  static handle from_cpp(const volcontact::Vector<N>& vector, rv_policy, cleanup_list* cleanup) {
    const auto array = volcontact::python::new_array<double, Shape>(
        {N}, [&vector](double* numbers) { vector.to(numbers); });
    return make_caster<std::decay_t<decltype(array)>>::from_cpp(array, rv_policy::reference,
                                                                cleanup);
  }
};

template <int R, int C>
struct type_caster<volcontact::Matrix<R, C>> {
  using Shape = nanobind::shape<R, C>;
  using Value_ = volcontact::Matrix<R, C>;
  NB_TYPE_CASTER(Value_, (make_caster<ndarray<double, numpy, Shape, c_contig>>::Name))

  template <typename Flags>
  bool from_python(handle source, Flags flags, cleanup_list* cleanup) noexcept {
    make_caster<volcontact::python::Numbers<double, Shape>> array;
    const auto some = static_cast<Flags>(flags & ~static_cast<Flags>(cast_flags::accepts_none));
    if (!array.from_python(source, some, cleanup)) return false;
    value = Value_::from_rows(array.value.data());
    return true;
  }
  static handle from_cpp(const Value_& matrix, rv_policy, cleanup_list* cleanup) {
    const auto array = volcontact::python::new_array<double, Shape>(
        {R, C}, [&matrix](double* numbers) { matrix.to_rows(numbers); });
    return make_caster<std::decay_t<decltype(array)>>::from_cpp(array, rv_policy::reference,
                                                                cleanup);
  }
};

}  // namespace nanobind::detail

namespace volcontact::python {

using Matrix4 = Matrix<4, 4>;
using Vector6 = Vector<6>;

/// Pose from a 4x4 matrix, the identity when none is given. Throws std::invalid_argument naming the
/// argument when it is not finite, not a rotation or has another last row.
Pose pose_from(const std::optional<Matrix4>& matrix, const char* name);

/// Twist from (angular [rad/s], linear [m/s]), zero when none is given.
Twist twist_from(const std::optional<Vector6>& vector, const char* name);

}  // namespace volcontact::python
