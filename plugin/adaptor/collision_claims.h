// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::adaptor {

/// Takes the listed pairs of attached mixed scenes (volcontact/option/pairs/listed) out of MuJoCo's
/// own collision, by wrapping its table of collision functions. All other pairs and models collide
/// as before. To be called once for every such scene, and undone once.
void claim_listed_pairs();
void unclaim_listed_pairs();

}  // namespace volcontact::adaptor
