// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "volcontact/base/simd.h"
#include "volcontact/base/types.h"
#include "volcontact/step/matrix/tree_matrix.h"

namespace volcontact {

inline constexpr int kRows = 6;  ///< of a contact place: along and about its three axes

/// A number for each row of a contact place, and zeros up to a whole register.
struct PlaceColumn {
  double numbers[kLanes] = {};

  Vector<kRows> rows() const { return Vector<kRows>::from(numbers); }
  bool is_zero() const { return rows().isZero(0.0); }
};

/// A degree of freedom that a place moves, or that carries one: the column of the place's Jacobian
/// J, carried through the factors U D L of Mh.
struct CarriedColumn {
  PlaceColumn moved;   ///< L'^-1 J'
  PlaceColumn forced;  ///< D^-1 U^-1 J'
  PlaceColumn massed;  ///< D^-1 L'^-1 J', of the factors of M, where H converts
  int dof;
};

/// L'^-1 x, or with `upper` U^-1 x, where x is zero but at `support`, which has with each degree of
/// freedom those that carry it, ascending.
void carry(const TreeMatrix& factor, bool upper, std::span<const int> support, PlaceColumn* x,
           SimdPath path = best_simd_path());

/// The sum over `carried` of moved forced', or of x forced' with x by degree of freedom, in their
/// order.
void sum_products(std::span<const CarriedColumn> carried, Matrix<kRows, kRows>& out,
                  SimdPath path = best_simd_path());
void sum_products(const PlaceColumn* x, std::span<const CarriedColumn> carried,
                  Matrix<kRows, kRows>& out, SimdPath path = best_simd_path());

/// The sum over `carried` of one of its columns times the number of the degree of freedom.
void sum_up(std::span<const CarriedColumn> carried, PlaceColumn CarriedColumn::* part,
            const double* numbers, double* out, SimdPath path = best_simd_path());

}  // namespace volcontact
