// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/material_rule.h"

#include <algorithm>

#include "volcontact/force/elastic_layer.h"

namespace volcontact {

constinit const Combination kLarger{
    "larger of: ", [](double a, double b, double, double) { return std::max(a, b); }};
constinit const Combination kInSeries{
    "in series: ", [](double a, double b, double, double) { return series_stiffness(a, b); }};
constinit const Combination kByCompliance{
    "weighted by compliance: ", [](double a, double b, double stiffness_a, double stiffness_b) {
      return series_damping(stiffness_a, a, stiffness_b, b);
    }};
constinit const Combination kRestitutionByCompliance{
    "its damping weighted by compliance: ",
    [](double a, double b, double stiffness_a, double stiffness_b) {
      return series_restitution(stiffness_a, a, stiffness_b, b);
    }};

}  // namespace volcontact
