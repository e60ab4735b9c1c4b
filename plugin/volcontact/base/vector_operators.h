// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <type_traits>

namespace volcontact {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

// Sums, multiples and products of vectors and matrices of three, evaluated at each step. Eigen
// makes a type of every expression and compiles a hundred functions of it; these are better matches
// than its operators, and leave few types. They round as Eigen does: the same bits.
namespace vector_operators {

/// A vector of three, or an expression for one whose numbers Eigen can load in pairs. Others, such
/// as the transpose of a row, stay its own: of them it adds in another order.
template <typename T>
concept Column =
    std::same_as<T, Vec3> ||
    (std::derived_from<T, Eigen::MatrixBase<T>> && std::same_as<typename T::Scalar, double> &&
     T::RowsAtCompileTime == 3 && T::ColsAtCompileTime == 1 &&
     (Eigen::internal::evaluator<T>::Flags & Eigen::PacketAccessBit) != 0);
template <typename T>
concept Number = std::is_arithmetic_v<T>;
template <typename T>
concept Transposed =
    std::same_as<T, Eigen::Transpose<Mat3>> || std::same_as<T, Eigen::Transpose<const Mat3>>;
template <typename T>
concept Square = std::same_as<T, Mat3> || Transposed<T>;

#define VOLCONTACT_VECTOR_INLINE [[gnu::always_inline]] inline

VOLCONTACT_VECTOR_INLINE const Vec3& plain(const Vec3& a) { return a; }
template <Column T>
VOLCONTACT_VECTOR_INLINE Vec3 plain(const T& a) {
  return a;
}

VOLCONTACT_VECTOR_INLINE double at(const Mat3& m, int i, int j) { return m.coeff(i, j); }
template <Transposed T>
VOLCONTACT_VECTOR_INLINE double at(const T& m, int i, int j) {
  return m.nestedExpression().coeff(j, i);
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

/// x + y + z as Eigen adds them. It makes the first two rows of a product as a pair, from its left
/// factor column by column, and the third by itself.
template <Square A, bool kTransposedToo = false>
VOLCONTACT_VECTOR_INLINE double sum_of_row(int i, double x, double y, double z) {
  const bool from_left = Transposed<A> ? !kTransposedToo : i < 2;
  return from_left ? (x + y) + z : x + (y + z);
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

template <vector_operators::Square M, vector_operators::Column A>
VOLCONTACT_VECTOR_INLINE Vec3 operator*(const M& m, const A& a) {
  using vector_operators::at;
  const Vec3& v = vector_operators::plain(a);
  const auto entry = [&](int i) {
    return vector_operators::sum_of_row<M>(i, at(m, i, 0) * v.x(), at(m, i, 1) * v.y(),
                                           at(m, i, 2) * v.z());
  };
  return {entry(0), entry(1), entry(2)};
}
template <vector_operators::Square A, vector_operators::Square B>
VOLCONTACT_VECTOR_INLINE Mat3 operator*(const A& a, const B& b) {
  using vector_operators::at;
  const auto entry = [&](int i, int j) {
    return vector_operators::sum_of_row<A, vector_operators::Transposed<B>>(
        i, at(a, i, 0) * at(b, 0, j), at(a, i, 1) * at(b, 1, j), at(a, i, 2) * at(b, 2, j));
  };
  Mat3 c;
  c.coeffRef(0, 0) = entry(0, 0);
  c.coeffRef(1, 0) = entry(1, 0);
  c.coeffRef(2, 0) = entry(2, 0);
  c.coeffRef(0, 1) = entry(0, 1);
  c.coeffRef(1, 1) = entry(1, 1);
  c.coeffRef(2, 1) = entry(2, 1);
  c.coeffRef(0, 2) = entry(0, 2);
  c.coeffRef(1, 2) = entry(1, 2);
  c.coeffRef(2, 2) = entry(2, 2);
  return c;
}

#undef VOLCONTACT_VECTOR_INLINE

}  // namespace volcontact
