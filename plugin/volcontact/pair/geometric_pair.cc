// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/geometric_pair.h"

#include <cstring>

namespace volcontact {
namespace {

// As a rule a solid has the pose of its body.
Pose pose_of_solid(const Pose& X_WA, const Pose& X_Aa) {
  static const Pose kIdentity;
  return std::memcmp(&X_Aa, &kIdentity, sizeof(Pose)) == 0 ? X_WA : X_WA * X_Aa;
}

}  // namespace

void interference_W(const GeometricPair& pair, const Pose& X_WA, const Pose& X_WB,
                    const InterferenceOptions& options, InterferenceWorkspace& workspace,
                    Interference& out) {
  const Pose X_Wa = pose_of_solid(X_WA, pair.X_Aa), X_Wb = pose_of_solid(X_WB, pair.X_Bb);
  interference(pair.a, pair.b, X_Wa.inverse() * X_Wb, options, workspace, out);
  if (!out.total.touching()) return;
  // As a rule the only site is the whole.
  const bool is_one = out.sites.size() == 1 && out.sites[0] == out.total;
  transform(X_Wa, out.total);
  if (is_one) {
    out.sites[0] = out.total;
    return;
  }
  for (VolumeMetrics& site : out.sites) transform(X_Wa, site);
}

}  // namespace volcontact
