// SPDX-License-Identifier: Apache-2.0
#include "adaptor/solids_of_geoms.h"

#include <iterator>

#include "volcontact/base/check.h"

namespace volcontact::adaptor {

const char* type_name(const mjModel* m, int geom) {
  static constexpr const char* kNames[] = {"plane",    "hfield", "sphere", "capsule", "ellipsoid",
                                           "cylinder", "box",    "mesh",   "sdf"};
  const int type = m->geom_type[geom];
  return type >= 0 && type < static_cast<int>(std::size(kNames)) ? kNames[type] : "unknown";
}

Shape solid_of_geom(const mjModel* m, int geom) {
  const Vec3 size = vec3_at(m->geom_size, geom);
  switch (m->geom_type[geom]) {
    case mjGEOM_PLANE:
      return HalfSpace();
    case mjGEOM_SPHERE:
      return Sphere({.radius = size.x()});
    case mjGEOM_CAPSULE:
      return Capsule({.radius = size.x(), .half_length = size.y()});
    case mjGEOM_ELLIPSOID:
      return Ellipsoid({.semi_axes = size});
    case mjGEOM_CYLINDER:
      return Cylinder({.radius = size.x(), .half_length = size.y()});
    case mjGEOM_BOX:
      return Box({.half_sizes = size});
    default:
      throw std::invalid_argument(
          "geom '" + label(m, mjOBJ_GEOM, geom) + "' is of type " + type_name(m, geom) +
          ", which comes with a later version of volcontact; build it of primitive geoms, or keep "
          "it out of contact with contype=\"0\" conaffinity=\"0\"");
  }
}

}  // namespace volcontact::adaptor
