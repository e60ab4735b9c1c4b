// SPDX-License-Identifier: Apache-2.0
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/string.h>

#include "bindings.h"
#include "fields.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::python {
namespace {

namespace nb = nanobind;

using Vertices = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

template <typename Solid>
std::string shape_doc() {
  return "Solid '" + std::string(Solid::kName) + "' in its own frame." + describe_fields<Solid>();
}

template <typename Solid>
void def_init(nb::class_<Solid>& type) {
  if constexpr (requires { Solid::kFields; }) {
    detail::def_shape_init<Solid>(type, std::make_index_sequence<Solid::kFields.size()>{});
    if constexpr (Solid::kFields.size() > 0) def_properties<Solid>(type);
  } else {
    type.def(
        "__init__",
        [](Solid* self, const Vertices& vertices) {
          std::vector<Vec3> points;
          for (Eigen::Index i = 0; i < vertices.rows(); ++i) points.push_back(vertices.row(i));
          new (self) Solid(points);
        },
        nb::arg("vertices"), "vertices [m], shape (n, 3): the solid is their convex hull");
  }
}

}  // namespace

void bind_shapes(nb::module_& m) {
  for_each_type(SimpleShapes{}, [&](auto tag) {
    using Solid = typename decltype(tag)::Type;
    nb::class_<Solid> type(m, camel_case(Solid::kName).c_str(), shape_doc<Solid>().c_str());
    def_init<Solid>(type);
    type.def(
            "own_metrics", [](const Solid& self) { return self.own_metrics(); },
            "Volume, centroid and inertia of the whole solid")
        .def(
            "signed_distance",
            [](const Solid& self, const Vec3& point) { return self.signed_distance(point); },
            nb::arg("point"),
            "Negative inside; never larger in magnitude than the distance to the surface [m]")
        .def(
            "support", [](const Solid& self, const Vec3& e) { return self.support(e); },
            nb::arg("direction"), "A point of the solid farthest along the direction [m]")
        .def("__repr__", [](const Solid& self) {
          std::string text = camel_case(Solid::kName) + "(";
          if constexpr (requires { self.params(); }) {
            for (const auto& field : Solid::kFields) {
              text += (text.back() == '(' ? "" : ", ") + std::string(field.name) + "=";
              std::string numbers;
              for (int i = 0; i < field.size(); ++i) {
                numbers += (i ? ", " : "") +
                           std::string(nb::repr(nb::float_(field.get(self.params(), i))).c_str());
              }
              text += field.size() == 1 ? numbers : "(" + numbers + ")";
            }
          }
          return text + ")";
        });
  });
}

}  // namespace volcontact::python
