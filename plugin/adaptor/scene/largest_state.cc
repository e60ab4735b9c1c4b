// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/largest_state.h"

#include "adaptor/keys/law_tables.h"
#include "adaptor/memory/mocap_row.h"
#include "adaptor/memory/site_pool.h"
#include "adaptor/memory/userdata_layout.h"
#include "volcontact/model/site_memory.h"
#include "volcontact/step/work_limit.h"

namespace volcontact::adaptor {
namespace {

// Numbers that a site of some pair of laws keeps at most.
int largest_row() {
  int normal = 0, friction = 0;
  for (const LawRow& law : normal_laws()) normal = std::max(normal, law.largest_state);
  for (const LawRow& law : friction_laws()) friction = std::max(friction, law.largest_state);
  return normal + friction == 0 ? 0 : kSiteHead + normal + friction;
}

}  // namespace

int largest_state(const mjModel* m) {
  const auto geoms = static_cast<std::size_t>(m->ngeom);
  const int rows = rows_for(geoms * geoms, geoms);
  const int channels = std::max(static_cast<int>(m->nv), 6 * static_cast<int>(m->nbody));
  const int states = SitePoolLayout{rows, largest_row()}.size() +
                     SitePoolLayout{rows, PairEnergy::kNumbers}.size();
  const auto nv = static_cast<int>(m->nv);
  return UserdataLayout{states,
                        channels,
                        rows,
                        nv,
                        static_cast<int>(m->nq) + nv,
                        static_cast<int>(m->nmocap) * MocapRow::kNumbers}
      .size();
}

}  // namespace volcontact::adaptor
