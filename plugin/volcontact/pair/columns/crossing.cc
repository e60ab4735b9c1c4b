// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/columns/crossing.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/fields.h"

namespace volcontact {
namespace {

struct TrianglePair {
  Vec3 f[3], g[3];
  int slot_f, slot_g;
};

// Where the outline of a triangle passes through a plane, given the distances of its corners.
struct Passage {
  Vec3 point[2];
  int edge[2];  // edge i goes from corner i to the next
  double along[2];
};

bool pass(const Vec3 corners[3], const double distance[3], const Vec3& direction,
          Passage& passage) {
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    if ((distance[i] >= 0.0) == (distance[j] >= 0.0)) continue;
    const double t = distance[i] / (distance[i] - distance[j]);
    passage.point[count] = corners[i] + t * (corners[j] - corners[i]);
    passage.edge[count] = i;
    passage.along[count] = direction.dot(passage.point[count]);
    ++count;
  }
  if (count != 2) return false;
  if (passage.along[1] < passage.along[0]) {
    std::swap(passage.point[0], passage.point[1]);
    std::swap(passage.edge[0], passage.edge[1]);
    std::swap(passage.along[0], passage.along[1]);
  }
  return true;
}

std::uint64_t key_of(const ObbTree& tree, int slot, int edge, int other_slot, bool of_b) {
  const int half_edge = 3 * slot + edge;
  const auto lower = static_cast<std::uint64_t>(std::min(half_edge, tree.twins[half_edge]));
  return (lower << 32 | static_cast<std::uint64_t>(other_slot)) << 1 | (of_b ? 1u : 0u);
}

// Adds the contact of two triangles, if they are in contact. The segment of two crossing triangles:
// Moeller, "A fast triangle-triangle intersection test", J. Graphics Tools 2(2), 1997.
void add_contact(const TrianglePair& pair, const ObbTree& a, const ObbTree& b, double reach,
                 std::vector<TriangleContact>& contacts) {
  const Vec3 normal_f = (pair.f[1] - pair.f[0]).cross(pair.f[2] - pair.f[0]);
  const Vec3 normal_g = (pair.g[1] - pair.g[0]).cross(pair.g[2] - pair.g[0]);
  double from_f[3], from_g[3];
  for (int i = 0; i < 3; ++i) {
    from_f[i] = normal_f.dot(pair.g[i] - pair.f[0]);
    from_g[i] = normal_g.dot(pair.f[i] - pair.g[0]);
  }
  const Vec3 direction = normal_f.cross(normal_g);
  TriangleContact contact{pair.slot_f, pair.slot_g, false, {}, {}, normal_f, normal_g, 0, 0};
  Passage on_f, on_g;
  if (pass(pair.f, from_g, direction, on_f) && pass(pair.g, from_f, direction, on_g)) {
    const bool f_first = on_f.along[0] > on_g.along[0], f_last = on_f.along[1] < on_g.along[1];
    const double enter = f_first ? on_f.along[0] : on_g.along[0];
    const double leave = f_last ? on_f.along[1] : on_g.along[1];
    if (enter < leave) {
      contact.proper = true;
      contact.p = f_first ? on_f.point[0] : on_g.point[0];
      contact.q = f_last ? on_f.point[1] : on_g.point[1];
      contact.key_p = f_first ? key_of(a, pair.slot_f, on_f.edge[0], pair.slot_g, false)
                              : key_of(b, pair.slot_g, on_g.edge[0], pair.slot_f, true);
      contact.key_q = f_last ? key_of(a, pair.slot_f, on_f.edge[1], pair.slot_g, false)
                             : key_of(b, pair.slot_g, on_g.edge[1], pair.slot_f, true);
      contacts.push_back(contact);
      return;
    }
    if (enter - leave > reach * direction.norm()) return;
  }
  // They touch at most: keep the common part of their bounds.
  Vec3 low = Vec3::Constant(-kInfinity), high = -low;
  for (const auto& corners : {pair.f, pair.g}) {
    low = low.cwiseMax(corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]));
    high = high.cwiseMin(corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]));
  }
  contact.p = low.cwiseMin(high);
  contact.q = high.cwiseMax(low);
  contacts.push_back(contact);
}

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/columns/crossing_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {

bool find_contacts(const ObbTree& a, const ObbTree& b, const Pose& X_BA, double reach, int most,
                   CrossingScratch& scratch) noexcept {
  return VOLCONTACT_SIMD_CALL(scratch.path, find_contacts_wide, a, b, X_BA, reach, most, scratch);
}

}  // namespace volcontact
