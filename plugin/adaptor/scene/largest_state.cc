// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/largest_state.h"

#include "adaptor/keys/law_tables.h"
#include "adaptor/memory/site_pool.h"
#include "adaptor/memory/userdata_layout.h"
#include "adaptor/memory/work_limit.h"
#include "adaptor/scene/mocap_motion.h"
#include "volcontact/force/laws.h"
#include "volcontact/model/contact_model.h"

namespace volcontact::adaptor {
namespace {

// Numbers that a site of some pair of laws keeps at most.
int largest_row() {
  int largest = 0;
  for (const LawRow& normal : normal_laws()) {
    // The speed at impact is kept where restitution is given.
    const FieldValues latching =
        normal.field("restitution") ? FieldValues{{"restitution", {0.5}}} : FieldValues{};
    for (const LawRow& friction : friction_laws()) {
      const ContactLaws laws{make_normal(normal.name, latching), make_friction(friction.name, {})};
      const ContactModel model({{Sphere({.radius = 1.0}), HalfSpace(), Pose{}, Pose{}}}, laws, {});
      largest = std::max(largest, model.row_size());
    }
  }
  return largest;
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
