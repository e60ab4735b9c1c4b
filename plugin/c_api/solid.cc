// SPDX-License-Identifier: Apache-2.0
#include "c_api/solid.h"

#include <algorithm>
#include <type_traits>

#include "c_api/guarded.h"

namespace volcontact::c_api {
namespace {

std::vector<Vec3> points_from(const double* numbers, int count, const char* function) {
  require_given(numbers, function, "the list of points");
  require(count > 0,
          std::string(function) + ": " + std::to_string(count) + " points, must be more than 0");
  std::vector<Vec3> points;
  points.reserve(static_cast<std::size_t>(count));
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    points.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  }
  return points;
}

Csg::Operation operation_from(const char* word) {
  const std::vector<std::string> words{"union", "intersection", "difference"};
  const auto found = std::find(words.begin(), words.end(), word);
  require(found != words.end(), unknown_word_message("operation", word, words));
  return static_cast<Csg::Operation>(found - words.begin());
}
static_assert(static_cast<int>(Csg::Operation::kIntersection) == 1);
static_assert(static_cast<int>(Csg::Operation::kDifference) == 2);

int give(NamedSolid solid, vc_solid** out) {
  *out = new vc_solid{std::move(solid)};
  return 0;
}

}  // namespace

NamedSolid NamedSolid::simple(std::string_view name) {
  NamedSolid solid{make_shape(name, {}), {}};
  solid.values = std::visit(
      [](const auto& made) -> FieldValues {
        using S = std::decay_t<decltype(made)>;
        if constexpr (requires { S::kFields; }) return values_of<S>(typename S::Params{});
        return {};
      },
      solid.shape);
  return solid;
}

const std::vector<double>& NamedSolid::get(std::string_view name) const {
  const auto found = values.find(name);
  if (found == values.end()) {
    std::string known;
    std::vector<std::string> names;
    for (const auto& [key, numbers] : values) {
      if (!names.empty()) known += ", ";
      known += key;
      names.push_back(key);
    }
    require(false, std::string(name_of(shape)) + " has no parameter '" + std::string(name) + "'" +
                       (known.empty() ? ", nor any other" : "; it has " + known) +
                       did_you_mean(name, names));
  }
  return found->second;
}

NamedSolid NamedSolid::with(std::string_view name, const double* numbers, int count) const {
  get(name);
  NamedSolid changed = *this;
  changed.values.find(name)->second = numbers_from(numbers, count, name);
  changed.shape = make_shape(name_of(shape), changed.values);
  return changed;
}

std::vector<NamedSolid::Row> NamedSolid::rows() const {
  return std::visit(
      [this](const auto& made) {
        std::vector<Row> rows;
        using S = std::decay_t<decltype(made)>;
        if constexpr (requires { S::kFields; }) {
          for (const auto& field : S::kFields) {
            if (values.count(field.name))
              rows.push_back({field.name, field.unit, field.range.text});
          }
        }
        return rows;
      },
      shape);
}

vc_metrics plain(const VolumeMetrics& from) noexcept {
  vc_metrics to{};
  to.volume = from.volume;
  from.centroid.to(to.centroid);
  from.inertia.to_rows(to.inertia);
  from.area_vector.to(to.area_vector);
  from.area_moment.to(to.area_moment);
  to.area = from.area;
  to.counter_area = from.counter_area;
  to.depth_moment = from.depth_moment;
  to.depth = from.depth;
  to.flatness = from.flatness();
  to.volume_error = from.volume_error;
  to.status = static_cast<int>(from.status);
  return to;
}

std::vector<double> numbers_from(const double* numbers, int count, std::string_view name) {
  require(numbers != nullptr, std::string(name) + ": the list of numbers is null");
  require(count > 0,
          std::string(name) + " takes at least one number, got " + std::to_string(count));
  return {numbers, numbers + count};
}

}  // namespace volcontact::c_api

using namespace volcontact;
using namespace volcontact::c_api;

extern "C" {

int vc_solid_create(const char* shape, vc_solid** solid) {
  return guarded([&, function = __func__] {
    require_given(shape, function, "shape");
    require_given(solid, function, "solid");
    return give(NamedSolid::simple(shape), solid);
  });
}

int vc_solid_create_mesh(const double* vertices, int vertex_count, const int* triangles,
                         int triangle_count, vc_solid** solid) {
  return guarded([&, function = __func__] {
    require_given(solid, function, "solid");
    require_given(triangles, function, "triangles");
    require(triangle_count > 0, std::string(function) + ": " + std::to_string(triangle_count) +
                                    " triangles, must be more than 0");
    std::vector<Triangle> list(static_cast<std::size_t>(triangle_count));
    for (std::size_t i = 0; i < list.size(); ++i)
      std::copy_n(triangles + 3 * i, 3, list[i].begin());
    return give({Mesh(points_from(vertices, vertex_count, function), list), {}}, solid);
  });
}

int vc_solid_create_polytope(const double* points, int point_count, vc_solid** solid) {
  return guarded([&, function = __func__] {
    require_given(solid, function, "solid");
    return give({ConvexPolytope(points_from(points, point_count, function)), {}}, solid);
  });
}

int vc_solid_combine(const char* operation, const vc_solid* a, const vc_solid* b,
                     const double* X_AB, vc_solid** solid) {
  return guarded([&, function = __func__] {
    require_given(operation, function, "operation");
    require_given(a, function, "a");
    require_given(b, function, "b");
    require_given(solid, function, "solid");
    const Csg posed = composed(b->named.shape).posed(pose_from(X_AB, "vc_solid_combine: X_AB"));
    const Csg made(operation_from(operation), composed(a->named.shape), posed);
    made.prepare();  // what is worked out once, before threads share it
    return give({made, {}}, solid);
  });
}

int vc_solid_set(vc_solid* solid, const char* name, const double* numbers, int count) {
  return guarded([&, function = __func__] {
    require_given(solid, function, "solid");
    require_given(name, function, "name");
    solid->named = solid->named.with(name, numbers, count);
    return 0;
  });
}

int vc_solid_get(const vc_solid* solid, const char* name, double* numbers, int capacity) {
  return guarded([&, function = __func__] {
    require_given(solid, function, "solid");
    require_given(name, function, "name");
    const std::vector<double>& values = solid->named.get(name);
    const int count = static_cast<int>(values.size());
    if (numbers) std::copy_n(values.begin(), std::clamp(capacity, 0, count), numbers);
    return count;
  });
}

int vc_solid_metrics(const vc_solid* solid, vc_metrics* metrics) {
  return guarded([&, function = __func__] {
    require_given(solid, function, "solid");
    require_given(metrics, function, "metrics");
    *metrics = plain(own_metrics_of(solid->named.shape));
    return 0;
  });
}

void vc_solid_free(vc_solid* solid) { delete solid; }

}  // extern "C"
