// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/place_columns.h"

#define VOLCONTACT_SIMD_KERNEL "volcontact/step/place_columns_kernel.inc"
#include "volcontact/base/simd_paths.inc"

namespace volcontact {

void carry(const TreeMatrix& factor, bool upper, std::span<const int> support, PlaceColumn* x,
           SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, carry, factor, upper ? factor.upper() : factor.lower(), support, x);
}

Matrix<kRows, kRows> sum_of_products(std::span<const CarriedColumn> carried, SimdPath path) {
  Matrix<kRows, kRows> out;
  VOLCONTACT_SIMD_CALL(path, sum_of_products, carried, out);
  return out;
}

Matrix<kRows, kRows> sum_of_products(const PlaceColumn* x, std::span<const CarriedColumn> carried,
                                     SimdPath path) {
  Matrix<kRows, kRows> out;
  VOLCONTACT_SIMD_CALL(path, sum_of_products, x, carried, out);
  return out;
}

void sum_up(std::span<const CarriedColumn> carried, PlaceColumn CarriedColumn::* part,
            const double* numbers, double* out, SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, sum_up, carried, part, numbers, out);
}

}  // namespace volcontact
