// SPDX-License-Identifier: Apache-2.0
#include "adaptor/model_content.h"

#include <algorithm>
#include <cstring>
#include <set>

namespace volcontact::adaptor {
namespace {

template <typename T, typename Visit>
void bytes_of(const T* array, std::size_t count, Visit& visit) {
  if (count > 0) visit(reinterpret_cast<const std::byte*>(array), count * sizeof(T));
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
                  const std::vector<int>& parts, const std::vector<int>& bodies, Visit visit) {
  const auto geoms = static_cast<std::size_t>(m->ngeom);
  for (const NumericSpan& span : numerics) {
    bytes_of(m->numeric_data + span.address, static_cast<std::size_t>(span.size), visit);
  }
  bytes_of(m->geom_size, 3 * geoms, visit);
  bytes_of(m->geom_friction, 3 * geoms, visit);
  bytes_of(m->pair_friction, 5 * static_cast<std::size_t>(m->npair), visit);
  bytes_of(m->geom_type, geoms, visit);
  bytes_of(m->geom_dataid, geoms, visit);
  bytes_of(m->hfield_data, static_cast<std::size_t>(m->nhfielddata), visit);
  bytes_of(m->geom_contype, geoms, visit);
  bytes_of(m->geom_conaffinity, geoms, visit);
  for (const int geom : parts) {
    bytes_of(m->geom_pos + 3 * geom, 3, visit);
    bytes_of(m->geom_quat + 4 * geom, 4, visit);
  }
  for (const int body : bodies) {
    bytes_of(m->body_pos + 3 * body, 3, visit);
    bytes_of(m->body_quat + 4 * body, 4, visit);
  }
  if (!parts.empty()) bytes_of(m->tuple_objprm, static_cast<std::size_t>(m->ntupledata), visit);
  const int parent_filter = m->opt.disableflags & mjDSBL_FILTERPARENT;
  bytes_of(&parent_filter, 1, visit);
}

// Compares what is visited with a stored copy.
class Comparison {
 public:
  explicit Comparison(const std::vector<std::byte>& stored) : stored_(stored) {}
  void operator()(const std::byte* data, std::size_t size) {
    equal_ = equal_ && size <= stored_.size() - at_ &&
             std::memcmp(data, stored_.data() + at_, size) == 0;
    if (equal_) at_ += size;
  }
  bool equal() const { return equal_ && at_ == stored_.size(); }

 private:
  const std::vector<std::byte>& stored_;
  std::size_t at_ = 0;
  bool equal_ = true;
};

auto copy_into(std::vector<std::byte>& bytes) {
  return [&bytes](const std::byte* data, std::size_t size) {
    bytes.insert(bytes.end(), data, data + size);
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

}  // namespace

ModelContent::ModelContent(const mjModel* m, const SceneKeys& keys,
                           const std::vector<std::vector<int>>& flush)
    : numerics_(merged(keys.numerics)) {
  for (const ComposedGeoms& solid : keys.solids) {
    for (const ComposedGeoms::Part& part : solid.parts) parts_.push_back(part.geom);
  }
  std::set<int> bodies;
  for (const std::vector<int>& group : flush) {
    const bool is_one_body = std::all_of(group.begin(), group.end(), [&](int geom) {
      return m->geom_bodyid[geom] == m->geom_bodyid[group.front()];
    });
    parts_.insert(parts_.end(), group.begin(), group.end());
    if (is_one_body) continue;
    for (const int geom : group) {
      for (int body = m->geom_bodyid[geom]; body != m->body_weldid[body];) {
        bodies.insert(body);
        body = m->body_parentid[body];
      }
    }
  }
  bodies_.assign(bodies.begin(), bodies.end());
  visit_structure(m, copy_into(structure_));
  visit_values(m, numerics_, parts_, bodies_, copy_into(values_));
}

bool ModelContent::is_same_model(const mjModel* m) const noexcept {
  Comparison comparison(structure_);
  visit_structure(m, [&](const std::byte* data, std::size_t size) { comparison(data, size); });
  return comparison.equal();
}

bool ModelContent::has_same_values(const mjModel* m) const noexcept {
  Comparison comparison(values_);
  visit_values(m, numerics_, parts_, bodies_,
               [&](const std::byte* data, std::size_t size) { comparison(data, size); });
  return comparison.equal();
}

}  // namespace volcontact::adaptor
