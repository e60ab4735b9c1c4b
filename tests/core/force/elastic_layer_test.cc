// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/elastic_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace volcontact::elastic_layer_test {
namespace {

TEST(ElasticLayer, FreeLayerIsModulusOverThickness) {
  EXPECT_DOUBLE_EQ(layer_stiffness(1e7, 0.05), 2e8);
}

TEST(ElasticLayer, ConfinedLayerHasTheConstrainedModulus) {
  // nu = 0 bulges not at all, free or not; nu = 0.25: 0.75 / (1.25 * 0.5) = 1.2.
  EXPECT_DOUBLE_EQ(confined_layer_stiffness(1e7, 0.05, 0.0), layer_stiffness(1e7, 0.05));
  EXPECT_DOUBLE_EQ(confined_layer_stiffness(1e7, 0.05, 0.25), 1.2 * 2e8);
  EXPECT_THROW(confined_layer_stiffness(1e7, 0.05, 0.5), std::invalid_argument);
}

TEST(ElasticLayer, TwoPiecesInSeries) {
  // Design notes, section 8, case 24.
  EXPECT_NEAR(series_stiffness(2e8, 5e8), 1.428571e8, 50.0);
  EXPECT_THROW(series_stiffness(2e8, 0.0), std::invalid_argument);
}

TEST(ElasticLayer, RigidPartnerAddsNothing) {
  EXPECT_NEAR(series_stiffness(2e8, 1e20), 2e8, 1e-3);
  EXPECT_NEAR(series_damping(2e8, 0.4, 1e20, 7.0), 0.4, 1e-9);
}

// Two layers under one pressure, p = k_i d_i (1 + a_i v) with the whole approach speed v: the exact
// series pressure at small a v, against k (d_A + d_B) (1 + a v).
TEST(ElasticLayer, SeriesDampingIsThatOfTwoLayersToFirstOrder) {
  const double kA = 2e8, kB = 5e8, aA = 0.3, aB = 0.9, v = 1e-4, overlap = 1e-3;
  const double compliance = 1.0 / (kA * (1.0 + aA * v)) + 1.0 / (kB * (1.0 + aB * v));
  const double pressure = overlap / compliance;
  const double elastic = series_stiffness(kA, kB) * overlap;
  EXPECT_NEAR((pressure / elastic - 1.0) / v, series_damping(kA, aA, kB, aB), 1e-5);
}

// Two equal springs in series are half as stiff, and share the deformation, however stiff they are.
TEST(ElasticLayer, StiffnessesToTheEndsOfTheirRange) {
  for (const double k : {1e-300, 1e-160, 1.0, 1e160, 1e300, 1e308, 1.7e308}) {
    EXPECT_EQ(series_stiffness(k, k), 0.5 * k);
    EXPECT_EQ(share_of_first(k, k), 0.5);
    EXPECT_EQ(series_damping(k, 0.5, k, 1.5), 1.0);
    EXPECT_NEAR(series_restitution(k, 0.7, k, 0.7), 0.7, 1e-12);
    EXPECT_EQ(series_stiffness(1.0, k), series_stiffness(k, 1.0));
  }
  EXPECT_EQ(series_stiffness(1e308, 1e-300), 1e-300);
  EXPECT_EQ(share_of_first(1e308, 1e-300), 0.0);
  EXPECT_EQ(share_of_first(1e-300, 1e308), 1.0);
  EXPECT_DOUBLE_EQ(share_of_first(1e8, 3e8), 0.75);
}

TEST(ElasticLayer, EqualRestitutionsStay) {
  EXPECT_NEAR(series_restitution(1e8, 0.7, 3e8, 0.7), 0.7, 1e-12);
  EXPECT_THROW(series_restitution(1e8, 0.0, 3e8, 0.7), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::elastic_layer_test
