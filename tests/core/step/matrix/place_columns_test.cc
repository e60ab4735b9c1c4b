// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/matrix/place_columns.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/random.h"

namespace volcontact::place_columns_test {
namespace {

// Two limbs, 0-1 and 2-3, of a trunk 4-5.
const std::vector<int> kParents = {1, 4, 3, 4, 5, -1};
const std::vector<int> kSupport = {0, 1, 4, 5};

std::vector<SimdPath> paths() {
  std::vector<SimdPath> out;
  for (const SimdPath path : {SimdPath::kPortable, SimdPath::kAvx2, SimdPath::kAvx512}) {
    if (can_run(path)) out.push_back(path);
  }
  return out;
}

PlaceColumn random_column(test::Random& random) {
  PlaceColumn out;
  for (int i = 0; i < kRows; ++i) out.numbers[i] = random.uniform(-1.0, 1.0);
  return out;
}

std::vector<CarriedColumn> random_columns(test::Random& random) {
  std::vector<CarriedColumn> out;
  for (const int dof : kSupport) {
    out.push_back({random_column(random), random_column(random), random_column(random), dof});
  }
  return out;
}

// Row by row as the matrix carries one vector.
TEST(PlaceColumns, EachRowIsCarriedAsAVector) {
  test::Random random(3);
  DofTrees trees;
  trees.set(kParents);
  TreeMatrix matrix;
  matrix.reset(trees, false);
  for (int i = 0; i < trees.size(); ++i) {
    matrix(i, i) = random.uniform(5.0, 6.0);
    for (int k = trees.parent(i); k >= 0; k = trees.parent(k)) {
      matrix(i, k) = random.uniform(-1.0, 1.0);
      matrix.mirrored(i, k) = random.uniform(-1.0, 1.0);
    }
  }
  matrix.factor();
  std::vector<PlaceColumn> columns(kParents.size());
  for (const int dof : {0, 1, 4}) columns[size(dof)] = random_column(random);
  for (const bool upper : {false, true}) {
    for (const SimdPath path : paths()) {
      std::vector<PlaceColumn> carried = columns;
      carry(matrix, upper, kSupport, carried.data(), path);
      for (int row = 0; row < kLanes; ++row) {
        double x[6];
        for (int dof = 0; dof < 6; ++dof) x[dof] = columns[size(dof)].numbers[row];
        upper ? matrix.carry_upper(kSupport, x) : matrix.carry_lower(kSupport, x);
        for (int dof = 0; dof < 6; ++dof) {
          EXPECT_EQ(carried[size(dof)].numbers[row], x[dof]) << dof << " " << row;
        }
      }
    }
  }
}

TEST(PlaceColumns, ProductsAreSummedUpInOrder) {
  test::Random random(4);
  const std::vector<CarriedColumn> carried = random_columns(random);
  std::vector<PlaceColumn> x(kParents.size());
  for (PlaceColumn& column : x) column = random_column(random);
  Matrix<kRows, kRows> own = Matrix<kRows, kRows>::Zero(), other = own;
  for (const CarriedColumn& one : carried) {
    own += outer(one.moved.rows(), one.forced.rows());
    other += outer(x[size(one.dof)].rows(), one.forced.rows());
  }
  for (const SimdPath path : paths()) {
    Matrix<kRows, kRows> out;
    sum_products(carried, out, path);
    EXPECT_EQ(out, own);
    sum_products(x.data(), carried, out, path);
    EXPECT_EQ(out, other);
  }
}

TEST(PlaceColumns, SumsAreSixNumbers) {
  test::Random random(5);
  const std::vector<CarriedColumn> carried = random_columns(random);
  const double numbers[] = {2.0, 0.0, 7.0, 7.0, -3.0, 0.5};
  Vector<kRows> truth = Vector<kRows>::Zero();
  for (const CarriedColumn& one : carried) truth += numbers[one.dof] * one.massed.rows();
  for (const SimdPath path : paths()) {
    double out[8] = {9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0, 9.0};
    sum_up(carried, &CarriedColumn::massed, numbers, out, path);
    EXPECT_EQ(Vector<kRows>::from(out), truth);
    EXPECT_EQ(out[6], 9.0);
    EXPECT_EQ(out[7], 9.0);
  }
}

}  // namespace
}  // namespace volcontact::place_columns_test
