// SPDX-License-Identifier: Apache-2.0
#include "adaptor/mujoco/mjgeoms.h"

#include <iterator>

namespace volcontact::adaptor {

const char* type_name(const mjModel* m, int geom) {
  static constexpr const char* kNames[] = {"plane",    "hfield", "sphere", "capsule", "ellipsoid",
                                           "cylinder", "box",    "mesh",   "sdf"};
  const int type = m->geom_type[geom];
  return type >= 0 && type < static_cast<int>(std::size(kNames)) ? kNames[type] : "unknown";
}

}  // namespace volcontact::adaptor
