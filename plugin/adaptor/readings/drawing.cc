// SPDX-License-Identifier: Apache-2.0
#include "adaptor/readings/drawing.h"
#include "adaptor/readings/last_evaluation.h"

#include <cmath>

namespace volcontact::adaptor {
namespace {

// A geom of the drawing whose z axis is along `axis`; null when the drawing is full.
void draw(mjvScene* scene, mjtGeom type, const Vec3& size, const Vec3& position, const Vec3& axis,
          const float* rgba) {
  if (scene->ngeom >= scene->maxgeom) return;
  mjtNum quaternion[4], rotation[9];
  mju_quatZ2Vec(quaternion, axis.data());
  mju_quat2Mat(rotation, quaternion);
  mjvGeom& geom = scene->geoms[scene->ngeom++];
  mjv_initGeom(&geom, type, size.data(), position.data(), rotation, rgba);
  geom.category = mjCAT_DECOR;
}

}  // namespace

void draw_sites(const SceneContact& contact, const mjModel* m, const mjData* d,
                const mjvOption* option, mjvScene* scene, EvaluationScratch& scratch) {
  const bool patches = option->flags[mjVIS_CONTACTPOINT] != 0;
  const bool forces = option->flags[mjVIS_CONTACTFORCE] != 0;
  if (!patches && !forces) return;
  if (!revisit(contact, m, d, scratch)) return;
  const double thickness = 0.5 * m->vis.scale.contactheight * m->stat.meansize;
  const double width = m->vis.scale.forcewidth * m->stat.meansize;
  const double scale = m->vis.map.force / m->stat.meanmass;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    for (const SiteReport& site : scratch.reports[k].sites) {
      const Vec3& place = site.metrics.centroid;
      const double radius = std::sqrt(site.metrics.area_vector.norm() / M_PI);
      if (patches && !site.normal.isZero(0.0)) {
        draw(scene, mjGEOM_CYLINDER, {radius, radius, thickness}, place, site.normal,
             m->vis.rgba.contactpoint);
      }
      const Vec3 force = -scale * site.force_on_A;
      if (forces && !force.isZero(0.0)) {
        draw(scene, mjGEOM_ARROW, {width, width, force.norm()}, place, force,
             m->vis.rgba.contactforce);
      }
    }
  }
}

}  // namespace volcontact::adaptor
