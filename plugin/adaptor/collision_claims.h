// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::adaptor {

/// Takes pairs of geoms of attached scenes out of MuJoCo's own collision, by wrapping its table of
/// collision functions: of mixed scenes (volcontact/option/pairs/listed) those that are listed, of
/// scenes with flexes all, so that flexes keep MuJoCo's contact. All other pairs and models collide
/// as before. To be called once for every such scene, and undone once.
void claim_pairs();
void unclaim_pairs();

}  // namespace volcontact::adaptor
