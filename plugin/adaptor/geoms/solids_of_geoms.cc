// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/solids_of_geoms.h"

#include "adaptor/geoms/mesh_solids.h"
#include "volcontact/base/check.h"

namespace volcontact::adaptor {

namespace {

// Pose of a geom in its body.
Pose pose_in_body(const mjModel* m, int geom) {
  mjtNum rotation[9];
  mju_quat2Mat(rotation, m->geom_quat + 4 * geom);
  return {Mat3::from_rows(rotation), vec3_at(m->geom_pos, geom)};
}

}  // namespace

Shape simple_solid(const mjModel* m, int geom, const SceneKeys& keys) {
  const GivenShape* given = keys.given_shape(geom);
  if (!given) return solid_of_geom(m, geom, keys.options.mesh);
  if (given->shape) return *given->shape;
  if (given->word == RoundedBox::kName) return rounded_box_of(m, geom, *given);
  return mesh_solid(m, geom, MeshForm::kHull);
}

Shape composed_solid(const mjModel* m, const ComposedGeoms& solid, const SceneKeys& keys) {
  const int first = solid.parts[0].geom;
  const Pose X_SB = pose_in_body(m, first).inverse();
  Csg whole = composed(simple_solid(m, first, keys));
  for (std::size_t i = 1; i < solid.parts.size(); ++i) {
    const ComposedGeoms::Part& part = solid.parts[i];
    const Pose X_SM = X_SB * pose_in_body(m, part.geom);
    whole = Csg(part.operation, whole, composed(simple_solid(m, part.geom, keys)).posed(X_SM));
  }
  whole.prepare();
  require(whole.own_metrics().volume > 0.0,
          solid.key +
              ": the geoms with prm=\"-1\" or \"2\" leave nothing; check their sizes and poses");
  return whole;
}

Shape solid_of_geom(const mjModel* m, int geom, MeshForm form) {
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
    case mjGEOM_MESH:
      return mesh_solid(m, geom, form);
    case mjGEOM_HFIELD:
      return height_field_solid(m, geom);
    default:
      throw std::invalid_argument(
          "geom '" + label(m, mjOBJ_GEOM, geom) + "' is of type " + type_name(m, geom) +
          ", which comes with a later version of volcontact; build it of primitive geoms, or keep "
          "it out of contact with contype=\"0\" conaffinity=\"0\"");
  }
}

}  // namespace volcontact::adaptor
