// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/geometric_pair.h"

namespace volcontact {

void interference_W(const GeometricPair& pair, const Pose& X_WA, const Pose& X_WB,
                    const InterferenceOptions& options, InterferenceWorkspace& workspace,
                    Interference& out) {
  const Pose X_Wa = X_WA * pair.X_Aa;
  const Pose X_Wb = X_WB * pair.X_Bb;
  interference(pair.a, pair.b, X_Wa.inverse() * X_Wb, options, workspace, out);
  if (!out.total.touching()) return;
  // As a rule the only site is the whole.
  const bool is_one = out.sites.size() == 1 && out.sites[0] == out.total;
  out.total = transformed(out.total, X_Wa);
  if (is_one) {
    out.sites[0] = out.total;
    return;
  }
  for (VolumeMetrics& site : out.sites) site = transformed(site, X_Wa);
}

}  // namespace volcontact
