// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/native_pairs.h"

#include <algorithm>

#include "adaptor/mujoco/mujoco_compat.h"

namespace volcontact::adaptor {
namespace {

constexpr double kMeanRounding = 1e-9;  // of a mean of two numbers

// Whether all `count` numbers lie between those of the geoms: any mixture of them does.
bool is_between(const mjtNum* number, const mjtNum* of_a, const mjtNum* of_b, int count) {
  for (int i = 0; i < count; ++i) {
    const auto [low, high] = std::minmax(of_a[i], of_b[i]);
    const double slack = kMeanRounding * std::max(std::abs(low), std::abs(high));
    if (number[i] < low - slack || number[i] > high + slack) return false;
  }
  return true;
}

// Of margin and gap, which some releases take the sum of.
bool is_up_to_sum(double number, double of_a, double of_b) {
  return number >= std::min(of_a, of_b) && number <= std::max({of_a, of_b, of_a + of_b});
}

}  // namespace

std::string native_pair_label(const mjModel* m, int pair) {
  const char* name = mj_id2name(m, mjOBJ_PAIR, pair);
  return name && *name ? "<pair> '" + std::string(name) + "'" : "<pair> " + std::to_string(pair);
}

std::vector<std::string> native_pair_fields_unused(const mjModel* m, int pair) {
  const int a = m->pair_geom1[pair], b = m->pair_geom2[pair];
  const mjtNum* friction = m->pair_friction + 5 * pair;  // sliding x2, spin, roll x2
  const mjtNum *of_a = m->geom_friction + 3 * a, *of_b = m->geom_friction + 3 * b;
  std::vector<std::string> fields;
  const auto name_unless = [&](bool meaningless, const char* field) {
    if (!meaningless) fields.emplace_back(field);
  };
  name_unless(friction[1] == friction[0], "friction[1], across the first direction");
  name_unless(is_between(friction + 2, of_a + 1, of_b + 1, 1), "friction[2], of spin");
  name_unless(is_between(friction + 3, of_a + 2, of_b + 2, 1) && friction[4] == friction[3],
              "friction[3] and [4], of rolling");
  const auto [low, high] = std::minmax(m->geom_condim[a], m->geom_condim[b]);
  name_unless(m->pair_dim[pair] >= low && m->pair_dim[pair] <= high, "condim");
  name_unless(is_between(m->pair_solref + mjNREF * pair, m->geom_solref + mjNREF * a,
                         m->geom_solref + mjNREF * b, mjNREF),
              "solref");
  name_unless(is_between(m->pair_solimp + mjNIMP * pair, m->geom_solimp + mjNIMP * a,
                         m->geom_solimp + mjNIMP * b, mjNIMP),
              "solimp");
  name_unless(is_up_to_sum(m->pair_margin[pair], m->geom_margin[a], m->geom_margin[b]), "margin");
  name_unless(is_up_to_sum(m->pair_gap[pair], m->geom_gap[a], m->geom_gap[b]), "gap");
#if mjVERSION_HEADER >= 300
  const mjtNum* across = m->pair_solreffriction + mjNREF * pair;
  name_unless(std::all_of(across, across + mjNREF, [](mjtNum x) { return x == 0.0; }),
              "solreffriction");
#endif
  return fields;
}

}  // namespace volcontact::adaptor
