// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/crossing/crossing_patches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "volcontact/base/disjoint_sets.h"
#include "volcontact/base/fields.h"

namespace volcontact {
namespace {

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
constexpr double kClosed = 1e-9;  // of the length of the curve
constexpr std::size_t kMostPatches = 100;
constexpr double kLeastArea = 1e-4;  // of the square of the length

void join_neighbors(const std::vector<TriangleContact>& contacts, PatchScratch& scratch) {
  std::size_t size = 16;
  while (size < 4 * contacts.size()) size *= 2;
  scratch.keys.assign(size, kEmpty);
  scratch.contact_at.resize(size);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!contacts[i].proper) continue;
    for (std::uint64_t key : {contacts[i].key_p, contacts[i].key_q}) {
      std::size_t at = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 20) & (size - 1);
      while (scratch.keys[at] != kEmpty && scratch.keys[at] != key) at = (at + 1) & (size - 1);
      if (scratch.keys[at] == key) {
        join_sets(scratch.parent, static_cast<int>(i), scratch.contact_at[at]);
      } else {
        scratch.keys[at] = key;
        scratch.contact_at[at] = static_cast<int>(i);
      }
    }
  }
}

// Sorts contacts by patch, in the order of the first of each; returns the number of patches.
int sort_by_patch(PatchScratch& scratch) {
  const int count = static_cast<int>(scratch.parent.size());
  scratch.number.assign(scratch.parent.size(), -1);
  int patches = 0;
  for (int i = 0; i < count; ++i) {
    int& number = scratch.number[root_of(scratch.parent, i)];
    if (number < 0) number = patches++;
  }
  scratch.order.resize(scratch.parent.size());
  scratch.starts.assign(static_cast<std::size_t>(patches) + 1, 0);
  const auto patch_of = [&](int i) { return scratch.number[root_of(scratch.parent, i)]; };
  for (int i = 0; i < count; ++i) ++scratch.starts[patch_of(i) + 1];
  std::partial_sum(scratch.starts.begin(), scratch.starts.end(), scratch.starts.begin());
  for (int i = 0; i < count; ++i) scratch.order[scratch.starts[patch_of(i)]++] = i;
  return patches;
}

void measure(const std::vector<TriangleContact>& contacts, PatchScratch& scratch, int patches) {
  scratch.patches.clear();
  const int count = static_cast<int>(scratch.order.size());
  for (int first = 0, last; first < count; first = last) {
    const auto patch_of = [&](int k) {
      return patches == 1 ? 0 : scratch.number[root_of(scratch.parent, scratch.order[k])];
    };
    const int patch = patch_of(first);
    for (last = first + 1; last < count && patch_of(last) == patch;) ++last;
    ContactPatch& out = scratch.patches.emplace_back();
    out.first = first;
    out.last = last;
    out.low = out.high = contacts[scratch.order[first]].p;
    for (int k = first; k < last; ++k) {
      const TriangleContact& contact = contacts[scratch.order[k]];
      out.low = out.low.cwiseMin(contact.p).cwiseMin(contact.q);
      out.high = out.high.cwiseMax(contact.p).cwiseMax(contact.q);
    }
  }
}

// Half of the middle extent of a patch: as far as the overlap may bulge beyond its curve.
double bulge(const ContactPatch& patch) {
  const Vec3 size = patch.high - patch.low;
  return 0.5 * (size.sum() - size.maxCoeff() - size.minCoeff());
}

bool near(const ContactPatch& a, const ContactPatch& b) {
  const Vec3 reach = Vec3::Constant(std::max(bulge(a), bulge(b)));
  return (a.low - b.high).at_most(reach) && (b.low - a.high).at_most(reach);
}

}  // namespace

CurveFlux flux_of(const std::vector<TriangleContact>& contacts, const int* first, const int* last) {
  CurveFlux flux;
  if (first == last) return flux;
  const Vec3 origin = contacts[*first].p;
  Vec3 gap = Vec3::Zero(), normals = Vec3::Zero();
  for (const int* i = first; i != last; ++i) {
    const TriangleContact& contact = contacts[*i];
    const Vec3 p = contact.p - origin, q = contact.q - origin;
    const double weight = (q - p).norm();
    if (contact.proper) {
      flux.area_vector += 0.5 * p.cross(q);
      gap += q - p;
      flux.length += weight;
    }
    normals += weight * (contact.normal_g.normalized() - contact.normal_f.normalized());
  }
  const double area = flux.area_vector.norm();
  flux.closed = gap.norm() <= kClosed * flux.length;
  if (flux.closed && area > kLeastArea * flux.length * flux.length) {
    flux.toward_a = -flux.area_vector / area;
  } else if (normals.norm() > 0.0) {
    flux.toward_a = normals.normalized();
  }
  return flux;
}

bool find_patches(const std::vector<TriangleContact>& contacts, PatchScratch& scratch) {
  make_sets(scratch.parent, contacts.size());
  join_neighbors(contacts, scratch);
  scratch.several.assign(contacts.size(), 0);
  // Until no two patches are near to each other.
  for (;;) {
    measure(contacts, scratch, sort_by_patch(scratch));
    if (scratch.patches.size() > kMostPatches) return false;
    bool joined = false;
    for (std::size_t i = 0; i < scratch.patches.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const ContactPatch &a = scratch.patches[i], &b = scratch.patches[j];
        const int root_a = scratch.order[a.first], root_b = scratch.order[b.first];
        if (root_of(scratch.parent, root_a) == root_of(scratch.parent, root_b)) continue;
        if (!near(a, b)) continue;
        join_sets(scratch.parent, root_a, root_b);
        scratch.several[root_of(scratch.parent, root_a)] = 1;
        joined = true;
      }
    }
    if (!joined) break;
  }
  for (ContactPatch& patch : scratch.patches) {
    patch.one_curve = scratch.several[root_of(scratch.parent, scratch.order[patch.first])] == 0;
    patch.flux =
        flux_of(contacts, scratch.order.data() + patch.first, scratch.order.data() + patch.last);
  }
  return true;
}

Aabb bounds_of(const std::vector<TriangleContact>& contacts, const PatchScratch& scratch,
               const ContactPatch& patch, const Pose& X_CB) {
  Aabb bounds{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  const auto add = [&](const Vec3& p_B) {
    const Vec3 p_C = X_CB * p_B;
    bounds.min = bounds.min.cwiseMin(p_C);
    bounds.max = bounds.max.cwiseMax(p_C);
  };
  for (int k = patch.first; k < patch.last; ++k) {
    const TriangleContact& contact = contacts[scratch.order[k]];
    const Vec3 &p = contact.p, &q = contact.q;
    if (contact.proper) {
      add(p);
      add(q);
      continue;
    }
    for (int corner = 0; corner < 8; ++corner) {  // a touch knows a box in B's frame only
      add(Vec3((corner & 1) ? q.x() : p.x(), (corner & 2) ? q.y() : p.y(),
               (corner & 4) ? q.z() : p.z()));
    }
  }
  return bounds;
}

Mat3 columns_along(const std::vector<TriangleContact>& contacts, const PatchScratch& scratch,
                   const ContactPatch& patch) {
  const Mat3 R_BC = basis_with_z(patch.flux.toward_a);
  const Vec3 middle = 0.5 * (patch.low + patch.high);
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (int k = patch.first; k < patch.last; ++k) {
    const TriangleContact& contact = contacts[scratch.order[k]];
    const Vec3 p = R_BC.transpose() * (0.5 * (contact.p + contact.q) - middle);
    xx += p.x() * p.x();
    xy += p.x() * p.y();
    yy += p.y() * p.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  Mat3 turned = R_BC;
  turned.col(0) = std::cos(angle) * R_BC.col(0) + std::sin(angle) * R_BC.col(1);
  turned.col(1) = R_BC.col(2).cross(turned.col(0));
  return turned;
}

}  // namespace volcontact
