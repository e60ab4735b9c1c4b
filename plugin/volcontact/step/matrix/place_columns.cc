// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/matrix/place_columns.h"

#define VOLCONTACT_SIMD_KERNEL "volcontact/step/matrix/place_columns_kernel.inc"
#include "volcontact/base/simd_paths.inc"

namespace volcontact {

void carry(const TreeMatrix& factor, bool upper, std::span<const int> support, PlaceColumn* x,
           SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, carry, factor, upper ? factor.upper() : factor.lower(), support, x);
}

void sum_products(std::span<const CarriedColumn> carried, Matrix<kRows, kRows>& out,
                  SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, sum_products, carried, out);
}

void sum_products(const PlaceColumn* x, std::span<const CarriedColumn> carried,
                  Matrix<kRows, kRows>& out, SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, sum_products, x, carried, out);
}

void sum_up(std::span<const CarriedColumn> carried, PlaceColumn CarriedColumn::* part,
            const double* numbers, double* out, SimdPath path) {
  VOLCONTACT_SIMD_CALL(path, sum_up, carried, part, numbers, out);
}

}  // namespace volcontact
