// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <type_traits>

namespace volcontact {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

// Sums and multiples of vectors of three, and sums of matrices, evaluated at each step. Eigen makes
// a type of every expression and compiles a hundred functions of it; these are better matches than
// its operators, and leave few types. They round as Eigen does: the same bits. So products with
// matrices stay Eigen's, which adds in another order in a longer product and makes (s M) v of
// s (M v).
namespace vector_operators {

template <typename T>
inline constexpr bool kIsProduct = false;
template <typename A, typename B, int option>
inline constexpr bool kIsProduct<Eigen::Product<A, B, option>> = true;

/// A vector of three, or an expression for one whose numbers Eigen can load in pairs. Others, such
/// as the transpose of a row, stay its own: of them it adds in another order.
template <typename T>
concept Column =
    std::same_as<T, Vec3> || (std::derived_from<T, Eigen::MatrixBase<T>> && !kIsProduct<T> &&
                              std::same_as<typename T::Scalar, double> &&
                              T::RowsAtCompileTime == 3 && T::ColsAtCompileTime == 1 &&
                              (Eigen::internal::evaluator<T>::Flags & Eigen::PacketAccessBit) != 0);
template <typename T>
concept Number = std::is_arithmetic_v<T>;
#define VOLCONTACT_VECTOR_INLINE [[gnu::always_inline]] inline

VOLCONTACT_VECTOR_INLINE const Vec3& plain(const Vec3& a) { return a; }
template <Column T>
VOLCONTACT_VECTOR_INLINE Vec3 plain(const T& a) {
  return a;
}

VOLCONTACT_VECTOR_INLINE Vec3 sum(const Vec3& a, const Vec3& b) {
  return {a.x() + b.x(), a.y() + b.y(), a.z() + b.z()};
}
VOLCONTACT_VECTOR_INLINE Vec3 difference(const Vec3& a, const Vec3& b) {
  return {a.x() - b.x(), a.y() - b.y(), a.z() - b.z()};
}
VOLCONTACT_VECTOR_INLINE Vec3 negative(const Vec3& a) { return {-a.x(), -a.y(), -a.z()}; }
VOLCONTACT_VECTOR_INLINE Vec3 multiple(double s, const Vec3& a) {
  return {s * a.x(), s * a.y(), s * a.z()};
}
VOLCONTACT_VECTOR_INLINE Vec3 quotient(const Vec3& a, double s) {
  return {a.x() / s, a.y() / s, a.z() / s};
}

}  // namespace vector_operators

template <vector_operators::Column A, vector_operators::Column B>
VOLCONTACT_VECTOR_INLINE Vec3 operator+(const A& a, const B& b) {
  return vector_operators::sum(vector_operators::plain(a), vector_operators::plain(b));
}
template <vector_operators::Column A, vector_operators::Column B>
VOLCONTACT_VECTOR_INLINE Vec3 operator-(const A& a, const B& b) {
  return vector_operators::difference(vector_operators::plain(a), vector_operators::plain(b));
}
template <vector_operators::Column A>
VOLCONTACT_VECTOR_INLINE Vec3 operator-(const A& a) {
  return vector_operators::negative(vector_operators::plain(a));
}
template <vector_operators::Number S, vector_operators::Column A>
VOLCONTACT_VECTOR_INLINE Vec3 operator*(S s, const A& a) {
  return vector_operators::multiple(static_cast<double>(s), vector_operators::plain(a));
}
template <vector_operators::Column A, vector_operators::Number S>
VOLCONTACT_VECTOR_INLINE Vec3 operator*(const A& a, S s) {
  return vector_operators::multiple(static_cast<double>(s), vector_operators::plain(a));
}
template <vector_operators::Column A, vector_operators::Number S>
VOLCONTACT_VECTOR_INLINE Vec3 operator/(const A& a, S s) {
  return vector_operators::quotient(vector_operators::plain(a), static_cast<double>(s));
}

template <std::same_as<Mat3> A, std::same_as<Mat3> B>
VOLCONTACT_VECTOR_INLINE Mat3 operator+(const A& a, const B& b) {
  Mat3 sum;
  for (int i = 0; i < 9; ++i) sum.data()[i] = a.data()[i] + b.data()[i];
  return sum;
}
template <std::same_as<Mat3> A, std::same_as<Mat3> B>
VOLCONTACT_VECTOR_INLINE Mat3 operator-(const A& a, const B& b) {
  Mat3 difference;
  for (int i = 0; i < 9; ++i) difference.data()[i] = a.data()[i] - b.data()[i];
  return difference;
}

#undef VOLCONTACT_VECTOR_INLINE

}  // namespace volcontact
