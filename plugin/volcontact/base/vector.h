// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/inline.h"

namespace volcontact {

// Vectors and matrices of fixed size: plain numbers, whose operators give plain numbers, under the
// names that Eigen gives them. Eigen makes a type of every expression and compiles a hundred
// functions of it; the core, which has thousands of them, took a third longer to compile. A sum of
// products runs from the first to the last.

/// Anything else with as many rows and columns, such as a matrix or an expression of Eigen.
template <typename T, int rows, int columns>
concept MatrixLike = requires(const T& m) {
  requires(T::RowsAtCompileTime == rows);
  requires(T::ColsAtCompileTime == columns);
  m.eval()(0, 0);
};

template <int N>
struct DiagonalMatrix;

template <int N>
struct Vector {
  double numbers[N];

  Vector() = default;  // not set
  Vector(const Vector&) = default;
  Vector& operator=(const Vector&) & = default;  // not to what a function gives back
  VOLCONTACT_INLINE explicit Vector(double x)
    requires(N == 1)
      : numbers{x} {}
  VOLCONTACT_INLINE Vector(double x, double y)
    requires(N == 2)
      : numbers{x, y} {}
  VOLCONTACT_INLINE Vector(double x, double y, double z)
    requires(N == 3)
      : numbers{x, y, z} {}
  VOLCONTACT_INLINE explicit Vector(const double (&values)[N]) {
    for (int i = 0; i < N; ++i) numbers[i] = values[i];
  }
  template <MatrixLike<N, 1> T>
  Vector(const T& expression) {
    const auto& v = expression.eval();
    for (int i = 0; i < N; ++i) numbers[i] = v(i, 0);
  }

  VOLCONTACT_INLINE static Vector Constant(double value) {
    return each([=](int) { return value; });
  }
  VOLCONTACT_INLINE static Vector Zero() { return Constant(0.0); }
  VOLCONTACT_INLINE static Vector Ones() { return Constant(1.0); }
  VOLCONTACT_INLINE static Vector Unit(int axis) {
    return each([=](int i) { return i == axis ? 1.0 : 0.0; });
  }
  VOLCONTACT_INLINE static Vector UnitX() { return Unit(0); }
  VOLCONTACT_INLINE static Vector UnitY() { return Unit(1); }
  VOLCONTACT_INLINE static Vector UnitZ()
    requires(N >= 3)
  {
    return Unit(2);
  }
  /// The N numbers from there on.
  VOLCONTACT_INLINE static Vector from(const double* first) {
    return each([=](int i) { return first[i]; });
  }
  VOLCONTACT_INLINE void to(double* first) const {
    for (int i = 0; i < N; ++i) first[i] = numbers[i];
  }

  VOLCONTACT_INLINE double& operator[](int i) & { return numbers[i]; }
  VOLCONTACT_INLINE double operator[](int i) const& { return numbers[i]; }
  VOLCONTACT_INLINE double& operator()(int i) & { return numbers[i]; }
  VOLCONTACT_INLINE double operator()(int i) const& { return numbers[i]; }
  VOLCONTACT_INLINE double& x() & { return numbers[0]; }
  VOLCONTACT_INLINE double& y() & { return numbers[1]; }
  VOLCONTACT_INLINE double& z() &
    requires(N >= 3)
  {
    return numbers[2];
  }
  VOLCONTACT_INLINE double x() const& { return numbers[0]; }
  VOLCONTACT_INLINE double y() const& { return numbers[1]; }
  VOLCONTACT_INLINE double z() const&
    requires(N >= 3)
  {
    return numbers[2];
  }
  VOLCONTACT_INLINE double* data() & { return numbers; }
  VOLCONTACT_INLINE const double* data() const& { return numbers; }
  VOLCONTACT_INLINE double* begin() & { return numbers; }
  VOLCONTACT_INLINE double* end() & { return numbers + N; }
  VOLCONTACT_INLINE const double* begin() const& { return numbers; }
  VOLCONTACT_INLINE const double* end() const& { return numbers + N; }
  static constexpr int size() { return N; }
  VOLCONTACT_INLINE void setZero() & { *this = Zero(); }
  /// The first M numbers.
  template <int M>
  VOLCONTACT_INLINE Vector<M> head() const {
    return Vector<M>::from(numbers);
  }
  /// The last M numbers.
  template <int M>
  VOLCONTACT_INLINE Vector<M> tail() const {
    return Vector<M>::from(numbers + (N - M));
  }

  VOLCONTACT_INLINE friend Vector operator+(const Vector& a, const Vector& b) {
    return each([&](int i) { return a[i] + b[i]; });
  }
  VOLCONTACT_INLINE friend Vector operator-(const Vector& a, const Vector& b) {
    return each([&](int i) { return a[i] - b[i]; });
  }
  VOLCONTACT_INLINE friend Vector operator-(const Vector& a) {
    return each([&](int i) { return -a[i]; });
  }
  VOLCONTACT_INLINE friend Vector operator*(double s, const Vector& a) {
    return each([&](int i) { return s * a[i]; });
  }
  VOLCONTACT_INLINE friend Vector operator*(const Vector& a, double s) { return s * a; }
  VOLCONTACT_INLINE friend Vector operator/(const Vector& a, double s) {
    return each([&](int i) { return a[i] / s; });
  }
  VOLCONTACT_INLINE Vector& operator+=(const Vector& b) & { return *this = *this + b; }
  VOLCONTACT_INLINE Vector& operator-=(const Vector& b) & { return *this = *this - b; }
  VOLCONTACT_INLINE Vector& operator*=(double s) & { return *this = s * *this; }
  VOLCONTACT_INLINE Vector& operator/=(double s) & { return *this = *this / s; }
  VOLCONTACT_INLINE friend bool operator==(const Vector& a, const Vector& b) {
    return all([&](int i) { return a[i] == b[i]; });
  }

  /// Its numbers with spaces between.
  template <typename Stream>
  friend Stream& operator<<(Stream& stream, const Vector& a) {
    for (int i = 0; i < N; ++i) stream << (i ? " " : "") << a[i];
    return stream;
  }

  VOLCONTACT_INLINE double dot(const Vector& b) const {
    return sum_of([&](int i) { return numbers[i] * b[i]; });
  }
  VOLCONTACT_INLINE double squaredNorm() const { return dot(*this); }
  VOLCONTACT_INLINE double norm() const { return std::sqrt(squaredNorm()); }
  /// Of length 1; a vector of length 0 stays what it is.
  VOLCONTACT_INLINE Vector normalized() const {
    const double square = squaredNorm();
    return square > 0.0 ? *this / std::sqrt(square) : *this;
  }
  /// The length, where its square would overflow or be lost.
  double stableNorm() const {
    const double largest = cwiseAbs().maxCoeff();
    return largest > 0.0 && std::isfinite(largest) ? largest * (*this / largest).norm() : largest;
  }
  VOLCONTACT_INLINE void normalize() & { *this = normalized(); }
  /// As normalized(), where the square of the length would overflow, or be lost.
  Vector stableNormalized() const {
    const double largest = cwiseAbs().maxCoeff();
    const double square = (*this / largest).squaredNorm();
    return square > 0.0 ? *this / (std::sqrt(square) * largest) : *this;
  }
  VOLCONTACT_INLINE Vector cross(const Vector& b) const
    requires(N == 3)
  {
    return {y() * b.z() - z() * b.y(), z() * b.x() - x() * b.z(), x() * b.y() - y() * b.x()};
  }
  VOLCONTACT_INLINE double sum() const {
    return sum_of([&](int i) { return numbers[i]; });
  }
  VOLCONTACT_INLINE double prod() const {
    double product = numbers[0];
    for (int i = 1; i < N; ++i) product *= numbers[i];
    return product;
  }
  VOLCONTACT_INLINE Vector cwiseAbs() const {
    return each([&](int i) { return std::abs(numbers[i]); });
  }
  VOLCONTACT_INLINE Vector cwiseAbs2() const { return cwiseProduct(*this); }
  VOLCONTACT_INLINE Vector cwiseProduct(const Vector& b) const {
    return each([&](int i) { return numbers[i] * b[i]; });
  }
  VOLCONTACT_INLINE Vector cwiseQuotient(const Vector& b) const {
    return each([&](int i) { return numbers[i] / b[i]; });
  }
  VOLCONTACT_INLINE Vector cwiseInverse() const {
    return each([&](int i) { return 1.0 / numbers[i]; });
  }
  VOLCONTACT_INLINE Vector cwiseSqrt() const {
    return each([&](int i) { return std::sqrt(numbers[i]); });
  }
  VOLCONTACT_INLINE Vector cwiseMax(const Vector& b) const {
    return each([&](int i) { return numbers[i] < b[i] ? b[i] : numbers[i]; });
  }
  VOLCONTACT_INLINE Vector cwiseMin(const Vector& b) const {
    return each([&](int i) { return b[i] < numbers[i] ? b[i] : numbers[i]; });
  }
  VOLCONTACT_INLINE Vector cwiseMax(double b) const { return cwiseMax(Constant(b)); }
  VOLCONTACT_INLINE Vector cwiseMin(double b) const { return cwiseMin(Constant(b)); }
  VOLCONTACT_INLINE DiagonalMatrix<N> asDiagonal() const { return {*this}; }
  VOLCONTACT_INLINE double maxCoeff() const {
    double largest = numbers[0];
    for (int i = 1; i < N; ++i) largest = largest < numbers[i] ? numbers[i] : largest;
    return largest;
  }
  VOLCONTACT_INLINE double minCoeff() const {
    double least = numbers[0];
    for (int i = 1; i < N; ++i) least = numbers[i] < least ? numbers[i] : least;
    return least;
  }
  /// The first of the largest.
  VOLCONTACT_INLINE int largest() const {
    int at = 0;
    for (int i = 1; i < N; ++i) {
      if (numbers[i] > numbers[at]) at = i;
    }
    return at;
  }
  /// The first of the least.
  VOLCONTACT_INLINE int least() const {
    int at = 0;
    for (int i = 1; i < N; ++i) {
      if (numbers[i] < numbers[at]) at = i;
    }
    return at;
  }
  /// Of the nearest whole numbers.
  Vector rounded() const {
    return each([&](int i) { return std::round(numbers[i]); });
  }
  VOLCONTACT_INLINE bool isZero(double precision = 1e-12) const {
    return all([&](int i) { return std::abs(numbers[i]) <= precision; });
  }
  VOLCONTACT_INLINE bool allFinite() const {
    return all([&](int i) { return std::isfinite(numbers[i]); });
  }
  bool isApprox(const Vector& b, double precision = 1e-12) const {
    return (*this - b).squaredNorm() <=
           precision * precision * std::fmin(squaredNorm(), b.squaredNorm());
  }
  /// Whether each number is at most, or less than, that of b.
  VOLCONTACT_INLINE bool at_most(const Vector& b) const {
    return all([&](int i) { return numbers[i] <= b[i]; });
  }
  VOLCONTACT_INLINE bool less_than(const Vector& b) const {
    return all([&](int i) { return numbers[i] < b[i]; });
  }
  /// Whether one number at least is greater than that of b.
  VOLCONTACT_INLINE bool exceeds(const Vector& b) const {
    return !all([&](int i) { return !(numbers[i] > b[i]); });
  }

 private:
  template <typename F>
  VOLCONTACT_INLINE static Vector each(const F& f) {
    if constexpr (N == 3) {
      return {f(0), f(1), f(2)};
    } else if constexpr (N == 2) {
      return {f(0), f(1)};
    } else {
      Vector v;
      for (int i = 0; i < N; ++i) v.numbers[i] = f(i);
      return v;
    }
  }
  template <typename F>
  VOLCONTACT_INLINE static double sum_of(const F& f) {
    if constexpr (N == 3) {
      return (f(0) + f(1)) + f(2);
    } else {
      double sum = f(0);
      for (int i = 1; i < N; ++i) sum += f(i);
      return sum;
    }
  }
  template <typename F>
  VOLCONTACT_INLINE static bool all(const F& f) {
    for (int i = 0; i < N; ++i) {
      if (!f(i)) return false;
    }
    return true;
  }
};

using Vec2 = Vector<2>;
using Vec3 = Vector<3>;

}  // namespace volcontact
