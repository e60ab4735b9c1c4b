// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/matrix/dense_matrix.h"

#include <algorithm>
#include <limits>

#include "volcontact/base/sizes.h"

#define VOLCONTACT_SIMD_KERNEL "volcontact/step/matrix/dense_kernel.inc"
#include "volcontact/base/simd_paths.inc"

namespace volcontact {

void DenseMatrix::reset(int size, bool is_symmetric) {
  size_ = size;
  eliminated_ = 0;
  is_symmetric_ = is_symmetric;
  stride_ = padded(size + kLanes);
  const std::size_t count = volcontact::size(size) * stride_;
  if (numbers_.size() < count) numbers_.resize(count);
  if (!is_symmetric && shares_.size() < count) shares_.resize(count);
  inverse_.resize(volcontact::size(size));
  whole_.resize(volcontact::size(size));
  // Registers reach as far beyond a column.
  for (int i = 0; i < size; ++i) {
    std::fill_n(column(i) + size, kLanes, 0.0);
    if (!is_symmetric) std::fill_n(&shares_[volcontact::size(i) * stride_] + size, kLanes, 0.0);
  }
}

void DenseMatrix::eliminate(int count, const double* whole) {
  eliminated_ = count;
  for (int i = 0; i < count; ++i) whole_[volcontact::size(i)] = whole ? whole[i] : column(i)[i];
  const auto stride = static_cast<std::ptrdiff_t>(stride_);
  if (is_symmetric_) {
    VOLCONTACT_SIMD_CALL(path, eliminate<true>, numbers_.data(), stride, size_, count,
                         whole_.data(), inverse_.data(), shares_.data());
  } else {
    VOLCONTACT_SIMD_CALL(path, eliminate<false>, numbers_.data(), stride, size_, count,
                         whole_.data(), inverse_.data(), shares_.data());
  }
}

void DenseMatrix::go_down(double* x) const {
  VOLCONTACT_SIMD_CALL(path, go_down, numbers_.data(), static_cast<std::ptrdiff_t>(stride_), size_,
                       eliminated_, inverse_.data(), x);
}

void DenseMatrix::go_up(double* x) const {
  const auto stride = static_cast<std::ptrdiff_t>(stride_);
  if (is_symmetric_) {
    VOLCONTACT_SIMD_CALL(path, go_up<true>, numbers_.data(), stride, size_, eliminated_,
                         inverse_.data(), x);
  } else {
    VOLCONTACT_SIMD_CALL(path, go_up<false>, shares_.data(), stride, size_, eliminated_,
                         inverse_.data(), x);
  }
}

void multiply(const double* matrix, int size, const double* x, double* y, SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, multiply, matrix, size, x, y);
}

void multiply_by_root(const double* columns, std::size_t stride, const Mat3& root, double* out,
                      SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, multiply_by_root, columns, static_cast<std::ptrdiff_t>(stride),
                       root.columns[0].data(), out);
}

void subtract_product(const double* matrix, int size, const double* a, const double* b, int count,
                      double* out, SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, subtract_product, matrix, size, a, b, count, out);
}

}  // namespace volcontact
