// SPDX-License-Identifier: Apache-2.0
#include "fmu/unit.h"

#include <fstream>

#include "fmu/contact/contact_unit.h"
#include "fmu/scene/scene_unit.h"

namespace volcontact::fmu {

std::unique_ptr<Unit> make_unit(const std::string& resources) {
  if (std::ifstream(resources + "/scene.txt").good()) return make_scene_unit(resources);
  return std::make_unique<ContactUnit>(resources);
}

void Unit::index_groups() {
  group_of_.clear();
  const auto& groups = file().groups;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    group_of_.insert(group_of_.end(), static_cast<std::size_t>(groups[g].count),
                     static_cast<int>(g));
  }
}

const Group* Unit::group_around(unsigned reference) const {
  if (reference >= group_of_.size()) return nullptr;
  return &file().groups[static_cast<std::size_t>(group_of_[reference])];
}

const Group* Unit::group(unsigned reference) const {
  const Group* around = group_around(reference);
  return around && around->first == static_cast<int>(reference) ? around : nullptr;
}

void Unit::require_finite(const Group& group, int offset, const double* numbers, int count) {
  for (int i = 0; i < count; ++i) {
    if (numbers[i] - numbers[i] != 0.0) {
      throw Discarded("value reference " + std::to_string(group.first + offset + i) +
                      ": the value is no finite number");
    }
  }
}

}  // namespace volcontact::fmu
