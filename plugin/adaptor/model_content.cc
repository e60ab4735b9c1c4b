// SPDX-License-Identifier: Apache-2.0
#include "adaptor/model_content.h"

#include <algorithm>
#include <set>

namespace volcontact::adaptor {
namespace {

template <typename T, typename Visit>
void bytes_of(const T* array, std::size_t count, Visit& visit, std::size_t per_row = 1) {
  const std::size_t size = count * sizeof(T);
  if (count > 0) visit(reinterpret_cast<const std::byte*>(array), size, sizeof(T) * per_row);
}

template <typename Visit>
void visit_structure(const mjModel* m, Visit visit) {
  const long long sizes[] = {m->nq,       m->nv,         m->nbody,       m->ngeom,
                             m->nnumeric, m->ntuple,     m->nnames,      m->npair,
                             m->nexclude, m->ntupledata, m->nnumericdata};
  bytes_of(sizes, std::size(sizes), visit);
  const auto bodies = static_cast<std::size_t>(m->nbody);
  bytes_of(m->names, static_cast<std::size_t>(m->nnames), visit);
  bytes_of(m->body_parentid, bodies, visit);
  bytes_of(m->body_weldid, bodies, visit);
  bytes_of(m->geom_bodyid, static_cast<std::size_t>(m->ngeom), visit);
  bytes_of(m->tuple_objid, static_cast<std::size_t>(m->ntupledata), visit);
  bytes_of(m->numeric_adr, static_cast<std::size_t>(m->nnumeric), visit);
  bytes_of(m->exclude_signature, static_cast<std::size_t>(m->nexclude), visit);
  bytes_of(m->pair_geom1, static_cast<std::size_t>(m->npair), visit);
  bytes_of(m->pair_geom2, static_cast<std::size_t>(m->npair), visit);
}

template <typename Visit>
void visit_values(const mjModel* m, const std::vector<NumericSpan>& numerics,
                  const std::vector<IndexSpan>& parts, const std::vector<IndexSpan>& bodies,
                  Visit visit) {
  const auto geoms = static_cast<std::size_t>(m->ngeom);
  for (const NumericSpan& span : numerics) {
    bytes_of(m->numeric_data + span.address, static_cast<std::size_t>(span.size), visit);
  }
  bytes_of(m->geom_size, 3 * geoms, visit, 3);
  bytes_of(m->geom_friction, 3 * geoms, visit, 3);
  bytes_of(m->pair_friction, 5 * static_cast<std::size_t>(m->npair), visit, 5);
  bytes_of(m->geom_type, geoms, visit);
  bytes_of(m->geom_dataid, geoms, visit);
  bytes_of(m->hfield_data, static_cast<std::size_t>(m->nhfielddata), visit);
  bytes_of(m->geom_contype, geoms, visit);
  bytes_of(m->geom_conaffinity, geoms, visit);
  const auto poses_of = [&](const std::vector<IndexSpan>& spans, const mjtNum* positions,
                            const mjtNum* quaternions) {
    for (const IndexSpan& span : spans) {
      const auto count = static_cast<std::size_t>(span.count);
      bytes_of(positions + std::ptrdiff_t{3} * span.first, 3 * count, visit, 3);
      bytes_of(quaternions + std::ptrdiff_t{4} * span.first, 4 * count, visit, 4);
    }
  };
  poses_of(parts, m->geom_pos, m->geom_quat);
  poses_of(bodies, m->body_pos, m->body_quat);
  if (!parts.empty()) bytes_of(m->tuple_objprm, static_cast<std::size_t>(m->ntupledata), visit);
  const int parent_filter = m->opt.disableflags & mjDSBL_FILTERPARENT;
  bytes_of(&parent_filter, 1, visit);
}

auto copy_into(ContentCopy& copy) {
  return [&copy](const std::byte* data, std::size_t size, std::size_t width) {
    copy.add(data, size, width);
  };
}

// Neighbouring spans as one, to compare them in one go.
std::vector<NumericSpan> merged(std::vector<NumericSpan> spans) {
  std::vector<NumericSpan> out;
  for (const NumericSpan& span : spans) {
    if (!out.empty() && out.back().address + out.back().size == span.address) {
      out.back().size += span.size;
    } else {
      out.push_back(span);
    }
  }
  return out;
}

// Neighbouring numbers as one span.
std::vector<IndexSpan> spans_of(const std::set<int>& indices) {
  std::vector<IndexSpan> out;
  for (const int index : indices) {
    if (out.empty() || out.back().first + out.back().count != index) out.push_back({index, 0});
    ++out.back().count;
  }
  return out;
}

}  // namespace

ModelContent::ModelContent(const mjModel* m, const SceneKeys& keys,
                           const std::vector<std::vector<int>>& flush)
    : numerics_(merged(keys.numerics)) {
  std::set<int> parts, bodies;
  for (const ComposedGeoms& solid : keys.solids) {
    for (const ComposedGeoms::Part& part : solid.parts) parts.insert(part.geom);
  }
  for (const std::vector<int>& group : flush) {
    const bool is_one_body = std::all_of(group.begin(), group.end(), [&](int geom) {
      return m->geom_bodyid[geom] == m->geom_bodyid[group.front()];
    });
    parts.insert(group.begin(), group.end());
    if (is_one_body) continue;
    for (const int geom : group) {
      for (int body = m->geom_bodyid[geom]; body != m->body_weldid[body];) {
        bodies.insert(body);
        body = m->body_parentid[body];
      }
    }
  }
  parts_ = spans_of(parts);
  bodies_ = spans_of(bodies);
  visit_structure(m, copy_into(structure_));
  visit_values(m, numerics_, parts_, bodies_, copy_into(values_));
}

bool ModelContent::is_same_model(const mjModel* m) const noexcept {
  ContentCopy::Comparison compare(structure_);
  visit_structure(
      m, [&](const std::byte* data, std::size_t size, std::size_t) { compare(data, size); });
  return compare.equal();
}

bool ModelContent::has_same_values(const mjModel* m) const noexcept {
  ContentCopy::Comparison compare(values_);
  visit_values(m, numerics_, parts_, bodies_,
               [&](const std::byte* data, std::size_t size, std::size_t) { compare(data, size); });
  return compare.equal();
}

}  // namespace volcontact::adaptor
