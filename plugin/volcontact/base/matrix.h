// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/vector.h"

namespace volcontact {

template <int R, int C>
struct Matrix {
  Vector<R> columns[C];

  Matrix() = default;  // not set
  Matrix(const Matrix&) = default;
  Matrix& operator=(const Matrix&) & = default;
  /// Numbers row by row.
  VOLCONTACT_INLINE Matrix(double m00, double m01, double m10, double m11)
    requires(R == 2 && C == 2)
      : columns{{m00, m10}, {m01, m11}} {}
  VOLCONTACT_INLINE Matrix(double m00, double m01, double m02, double m10, double m11, double m12,
                           double m20, double m21, double m22)
    requires(R == 3 && C == 3)
      : columns{{m00, m10, m20}, {m01, m11, m21}, {m02, m12, m22}} {}
  VOLCONTACT_INLINE Matrix(const DiagonalMatrix<R>& diagonal)
    requires(R == C)
  {
    for (int k = 0; k < C; ++k) columns[k] = diagonal.numbers[k] * Vector<R>::Unit(k);
  }
  template <MatrixLike<R, C> T>
  Matrix(const T& expression) {
    const auto& m = expression.eval();
    for (int k = 0; k < C; ++k) {
      for (int i = 0; i < R; ++i) columns[k][i] = m(i, k);
    }
  }

  VOLCONTACT_INLINE static Matrix Constant(double value) {
    return each([=](int) { return Vector<R>::Constant(value); });
  }
  VOLCONTACT_INLINE static Matrix Zero() { return Constant(0.0); }
  VOLCONTACT_INLINE static Matrix Identity() {
    return each([=](int k) { return Vector<R>::Unit(k); });
  }
  /// From numbers in the order of a matrix whose rows, or whose columns, lie one after another.
  VOLCONTACT_INLINE static Matrix from_rows(const double* first) {
    Matrix m;
    for (int i = 0; i < R; ++i) {
      for (int k = 0; k < C; ++k) m.columns[k][i] = first[C * i + k];
    }
    return m;
  }
  VOLCONTACT_INLINE static Matrix from(const double* first) {
    return each([=](int k) { return Vector<R>::from(first + R * k); });
  }
  VOLCONTACT_INLINE static Matrix with_columns(const Vector<R>& a, const Vector<R>& b,
                                               const Vector<R>& c)
    requires(C == 3)
  {
    Matrix m;
    m.columns[0] = a;
    m.columns[1] = b;
    m.columns[2] = c;
    return m;
  }
  VOLCONTACT_INLINE static Matrix with_rows(const Vector<C>& a, const Vector<C>& b,
                                            const Vector<C>& c)
    requires(R == 3)
  {
    return Matrix<C, 3>::with_columns(a, b, c).transpose();
  }
  VOLCONTACT_INLINE void to_rows(double* first) const {
    for (int i = 0; i < R; ++i) {
      for (int k = 0; k < C; ++k) first[C * i + k] = columns[k][i];
    }
  }
  VOLCONTACT_INLINE void to(double* first) const {
    for (int k = 0; k < C; ++k) columns[k].to(first + R * k);
  }

  VOLCONTACT_INLINE double& operator()(int i, int k) & { return columns[k][i]; }
  VOLCONTACT_INLINE double operator()(int i, int k) const& { return columns[k][i]; }
  VOLCONTACT_INLINE Vector<R>& col(int k) & { return columns[k]; }
  VOLCONTACT_INLINE const Vector<R>& col(int k) const& { return columns[k]; }
  VOLCONTACT_INLINE Vector<R> col(int k) const&& { return columns[k]; }
  VOLCONTACT_INLINE Vector<C> row(int i) const {
    Vector<C> v;
    for (int k = 0; k < C; ++k) v[k] = columns[k][i];
    return v;
  }
  VOLCONTACT_INLINE void set_row(int i, const Vector<C>& v) {
    for (int k = 0; k < C; ++k) columns[k][i] = v[k];
  }
  /// The first M columns.
  template <int M>
  VOLCONTACT_INLINE Matrix<R, M> leftCols() const {
    Matrix<R, M> m;
    for (int k = 0; k < M; ++k) m.columns[k] = columns[k];
    return m;
  }
  /// The block of M x K whose first number is (i, k).
  template <int M, int K>
  VOLCONTACT_INLINE Matrix<M, K> block(int i, int k) const {
    Matrix<M, K> m;
    for (int j = 0; j < K; ++j) m.columns[j] = Vector<M>::from(columns[k + j].data() + i);
    return m;
  }
  template <int M, int K>
  VOLCONTACT_INLINE void set_block(int i, int k, const Matrix<M, K>& m) {
    for (int j = 0; j < K; ++j) m.columns[j].to(columns[k + j].data() + i);
  }
  /// Adds m to the block whose first number is (i, k).
  template <int M, int K>
  VOLCONTACT_INLINE void add_block(int i, int k, const Matrix<M, K>& m) {
    set_block(i, k, block<M, K>(i, k) + m);
  }

  VOLCONTACT_INLINE friend Matrix operator+(const Matrix& a, const Matrix& b) {
    return each([&](int k) { return a.columns[k] + b.columns[k]; });
  }
  VOLCONTACT_INLINE friend Matrix operator-(const Matrix& a, const Matrix& b) {
    return each([&](int k) { return a.columns[k] - b.columns[k]; });
  }
  VOLCONTACT_INLINE friend Matrix operator-(const Matrix& a) {
    return each([&](int k) { return -a.columns[k]; });
  }
  VOLCONTACT_INLINE friend Matrix operator*(double s, const Matrix& a) {
    return each([&](int k) { return s * a.columns[k]; });
  }
  VOLCONTACT_INLINE friend Matrix operator*(const Matrix& a, double s) { return s * a; }
  VOLCONTACT_INLINE friend Matrix operator/(const Matrix& a, double s) {
    return each([&](int k) { return a.columns[k] / s; });
  }
  VOLCONTACT_INLINE Matrix& operator+=(const Matrix& b) & { return *this = *this + b; }
  VOLCONTACT_INLINE Matrix& operator-=(const Matrix& b) & { return *this = *this - b; }
  VOLCONTACT_INLINE Matrix& operator*=(double s) & { return *this = s * *this; }
  VOLCONTACT_INLINE Matrix& operator/=(double s) & { return *this = *this / s; }
  VOLCONTACT_INLINE friend bool operator==(const Matrix& a, const Matrix& b) {
    for (int k = 0; k < C; ++k) {
      if (!(a.columns[k] == b.columns[k])) return false;
    }
    return true;
  }

  VOLCONTACT_INLINE friend Vector<R> operator*(const Matrix& m, const Vector<C>& v) {
    if constexpr (C == 3) {
      return (v[0] * m.columns[0] + v[1] * m.columns[1]) + v[2] * m.columns[2];
    } else {
      Vector<R> out = v[0] * m.columns[0];
      for (int k = 1; k < C; ++k) out += v[k] * m.columns[k];
      return out;
    }
  }
  /// Of the transpose, without making it.
  VOLCONTACT_INLINE Vector<C> transposed_times(const Vector<R>& v) const {
    Vector<C> out;
    for (int k = 0; k < C; ++k) out[k] = columns[k].dot(v);
    return out;
  }
  template <int K>
  VOLCONTACT_INLINE friend Matrix<R, K> operator*(const Matrix& a, const Matrix<C, K>& b) {
    Matrix<R, K> out;
    for (int k = 0; k < K; ++k) out.columns[k] = a * b.columns[k];
    return out;
  }
  VOLCONTACT_INLINE Matrix<C, R> transpose() const {
    Matrix<C, R> out;
    for (int i = 0; i < R; ++i) out.columns[i] = row(i);
    return out;
  }

  VOLCONTACT_INLINE Vector<R> diagonal() const
    requires(R == C)
  {
    Vector<R> out;
    for (int k = 0; k < C; ++k) out[k] = columns[k][k];
    return out;
  }
  VOLCONTACT_INLINE double trace() const
    requires(R == C)
  {
    return diagonal().sum();
  }
  VOLCONTACT_INLINE double determinant() const
    requires(R == 2 && C == 2)
  {
    return columns[0][0] * columns[1][1] - columns[1][0] * columns[0][1];
  }
  double determinant() const
    requires(R == 3 && C == 3)
  {
    return columns[0].dot(columns[1].cross(columns[2]));
  }
  /// By its cofactors.
  Matrix inverse() const
    requires(R == 3 && C == 3)
  {
    Matrix rows;
    for (int k = 0; k < 3; ++k) rows.columns[k] = columns[(k + 1) % 3].cross(columns[(k + 2) % 3]);
    return (1.0 / columns[0].dot(rows.columns[0])) * rows.transpose();
  }
  VOLCONTACT_INLINE double squaredNorm() const {
    double sum = columns[0].squaredNorm();
    for (int k = 1; k < C; ++k) sum += columns[k].squaredNorm();
    return sum;
  }
  VOLCONTACT_INLINE double norm() const { return std::sqrt(squaredNorm()); }
  VOLCONTACT_INLINE double sum() const {
    double sum = columns[0].sum();
    for (int k = 1; k < C; ++k) sum += columns[k].sum();
    return sum;
  }
  VOLCONTACT_INLINE Matrix cwiseAbs() const {
    return each([&](int k) { return columns[k].cwiseAbs(); });
  }
  bool isApprox(const Matrix& b, double precision = 1e-12) const {
    return (*this - b).squaredNorm() <=
           precision * precision * std::fmin(squaredNorm(), b.squaredNorm());
  }
  /// Of the nearest whole numbers.
  Matrix rounded() const {
    return each([&](int k) { return columns[k].rounded(); });
  }
  VOLCONTACT_INLINE Matrix cwiseAbs2() const {
    return each([&](int k) { return columns[k].cwiseAbs2(); });
  }
  VOLCONTACT_INLINE double maxCoeff() const {
    double largest = columns[0].maxCoeff();
    for (int k = 1; k < C; ++k) {
      const double other = columns[k].maxCoeff();
      largest = largest < other ? other : largest;
    }
    return largest;
  }
  VOLCONTACT_INLINE bool isZero(double precision = 1e-12) const {
    for (int k = 0; k < C; ++k) {
      if (!columns[k].isZero(precision)) return false;
    }
    return true;
  }
  VOLCONTACT_INLINE bool allFinite() const {
    for (int k = 0; k < C; ++k) {
      if (!columns[k].allFinite()) return false;
    }
    return true;
  }
  VOLCONTACT_INLINE void setZero() & { *this = Zero(); }

 private:
  template <typename F>
  VOLCONTACT_INLINE static Matrix each(const F& f) {
    Matrix m;
    if constexpr (C == 3) {
      m.columns[0] = f(0);
      m.columns[1] = f(1);
      m.columns[2] = f(2);
    } else {
      for (int k = 0; k < C; ++k) m.columns[k] = f(k);
    }
    return m;
  }
};

/// A matrix with these numbers on its diagonal and no others.
template <int N>
struct DiagonalMatrix {
  Vector<N> numbers;

  VOLCONTACT_INLINE friend Matrix<N, N> operator*(const Matrix<N, N>& m, const DiagonalMatrix& d) {
    Matrix<N, N> out;
    for (int k = 0; k < N; ++k) out.columns[k] = d.numbers[k] * m.columns[k];
    return out;
  }
  VOLCONTACT_INLINE friend Matrix<N, N> operator*(const DiagonalMatrix& d, const Matrix<N, N>& m) {
    Matrix<N, N> out;
    for (int k = 0; k < N; ++k) out.columns[k] = d.numbers.cwiseProduct(m.columns[k]);
    return out;
  }
};

/// Outer product: outer(a, b) c = a (b . c).
template <int R, int C>
VOLCONTACT_INLINE Matrix<R, C> outer(const Vector<R>& a, const Vector<C>& b) {
  Matrix<R, C> m;
  for (int k = 0; k < C; ++k) m.columns[k] = b[k] * a;
  return m;
}

/// The length of each row.
template <int R, int C>
VOLCONTACT_INLINE Vector<R> row_lengths(const Matrix<R, C>& m) {
  Vector<R> squares = m.columns[0].cwiseAbs2();
  for (int k = 1; k < C; ++k) squares += m.columns[k].cwiseAbs2();
  return squares.cwiseSqrt();
}

using Mat2 = Matrix<2, 2>;
using Mat3 = Matrix<3, 3>;

}  // namespace volcontact
