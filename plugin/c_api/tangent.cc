// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/contact_tangent.h"

#include "c_api/guarded.h"
#include "c_api/model.h"
#include "c_api/workspace.h"
#include "volcontact/base/check.h"

using namespace volcontact;
using namespace volcontact::c_api;

extern "C" int vc_tangent_of(const vc_model* model, vc_workspace* workspace, vc_tangent* tangent) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require_given(workspace, function, "workspace");
    require_given(tangent, function, "tangent");
    check(model->contact && workspace->model == &*model->contact, [] {
      return "vc_tangent_of: the workspace has no evaluation of this model as it is now; call "
             "vc_evaluate first";
    });
    const ContactTangent found = contact_tangent(*model->contact, workspace->report);
    check(found.by_motion.allFinite() && found.by_speed.allFinite(),
          [] { return "vc_tangent_of: a derivative is no finite number"; });
    found.by_motion.to_rows(tangent->by_motion);
    found.by_speed.to_rows(tangent->by_speed);
    return 0;
  });
}
