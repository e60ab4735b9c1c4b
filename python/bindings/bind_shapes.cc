// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "fields.h"
#include "volcontact/shape/shapes.h"

namespace volcontact::python {
namespace {

namespace nb = nanobind;

template <typename Solid>
std::string shape_doc() {
  return "Solid '" + std::string(Solid::kName) + "' in its own frame." + describe_fields<Solid>();
}

// "Sphere(radius=0.1)".
template <typename Solid>
std::string shape_text(const Solid& solid) {
  std::string text = camel_case(Solid::kName) + "(";
  if constexpr (requires { solid.params(); }) {
    for (const auto& field : Solid::kFields) {
      text += (text.back() == '(' ? "" : ", ") + std::string(field.name) + "=";
      std::string numbers;
      for (int i = 0; i < field.size(); ++i) {
        numbers += (i ? ", " : "") +
                   std::string(nb::repr(nb::float_(field.get(solid.params(), i))).c_str());
      }
      text += field.size() == 1 ? numbers : "(" + numbers + ")";
    }
  }
  return text + ")";
}

// "(Box(half_sizes=(...)) - Cylinder(...))"; poses are left out.
std::string csg_text(const Csg& solid) {
  std::vector<std::string> waiting;
  for (const Csg::Step& step : solid.steps()) {
    if (step.member >= 0) {
      waiting.push_back(std::visit([](const auto& shape) { return shape_text(shape); },
                                   solid.members()[step.member].shape));
      continue;
    }
    const std::string b = std::move(waiting.back());
    waiting.pop_back();
    constexpr const char* kSigns[] = {" + ", " & ", " - "};
    waiting.back() = "(" + waiting.back() + kSigns[static_cast<int>(step.operation)] + b + ")";
  }
  return waiting.back();
}

std::vector<Vec3> points_from(const RowsOfThree& rows) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    points.push_back(Vec3::from(rows.data() + 3 * i));
  }
  return points;
}

template <typename Solid>
void def_init(nb::class_<Solid>& type) {
  if constexpr (requires { Solid::kFields; }) {
    detail::def_shape_init<Solid>(type, std::make_index_sequence<Solid::kFields.size()>{});
    if constexpr (Solid::kFields.size() > 0) def_properties<Solid>(type);
  } else {
    type.def(
        "__init__",
        [](Solid* self, const RowsOfThree& vertices) { new (self) Solid(points_from(vertices)); },
        nb::arg("vertices"), "vertices [m], shape (n, 3): the solid is their convex hull");
  }
}

// What all solids have. `Csg` takes part in every operator, so it must be bound first.
template <typename Solid>
void def_solid(nb::class_<Solid>& type) {
  using Operation = Csg::Operation;
  const auto join = [&type](const char* name, Operation operation, const char* doc) {
    type.def(
        name,
        [operation](const Solid& a, const Shape& b) {
          return Csg(operation, composed(a), composed(b));
        },
        nb::arg("other"), nb::is_operator(), doc);
  };
  join("__add__", Operation::kUnion, "Union with another solid, in one common frame");
  join("__and__", Operation::kIntersection, "What both solids hold, in one common frame");
  join("__sub__", Operation::kDifference, "This solid without the other, in one common frame");
  type.def(
          "posed",
          [](const Solid& self, const Matrix4& X) {
            return composed(self).posed(pose_from(X, "posed: X"));
          },
          nb::arg("X"), R"(The same solid elsewhere, as a member of a composed solid.

Args:
    X: pose of this solid in the frame of the new one, shape (4, 4)

Returns:
    Csg: the solid in its place

Raises:
    ValueError: X is no pose)")
      .def(
          "own_metrics", [](const Solid& self) { return self.own_metrics(); },
          "Volume, centroid and inertia of the whole solid")
      .def(
          "signed_distance",
          [](const Solid& self, const Vec3& point) { return self.signed_distance(point); },
          nb::arg("point"),
          "Negative inside; never larger in magnitude than the distance to the surface [m]")
      .def_prop_ro(
          "bounds",
          [](const Solid& self) {
            const Aabb box = self.bounds();
            return std::pair(box.min, box.max);
          },
          "Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the "
          "solid is unbounded");
}

void bind_csg(nb::module_& m) {
  nb::class_<Csg> type(m, "Csg",
                       R"(Solid 'csg', composed of others: a + b, a & b, a - b, nested as wanted.

Made by the operators of any solid, and by solid.posed(X), which puts a member in its place:

    bored = vc.Box((0.1, 0.1, 0.02)) - vc.Cylinder(0.01, 0.05).posed(X)

A half-space may be a member; where the solid stays unbounded it can only meet bounded ones.)");
  def_solid(type);
  type.def_prop_ro(
          "members", [](const Csg& self) { return self.members().size(); },
          "How many simple solids it is made of")
      .def("__repr__", [](const Csg& self) { return csg_text(self); });
}

// nanobind changes the numbers of NumPy's own arrays alone, not those of types derived from them.
RowsOfThree rows_from(const nb::object& array, const char* message) {
  RowsOfThree rows;
  if (!nb::try_cast(nb::module_::import_("numpy").attr("asarray")(array), rows)) {
    throw nb::type_error(message);
  }
  return rows;
}

// From numbers as they were given: a cast to int would make 0.5 and 2^32 a silent 0.
std::vector<Triangle> triangles_from(const nb::object& given) {
  const auto faces =
      rows_from(given, "mesh: faces must be an array of whole numbers, shape (m, 3)");
  constexpr double kMost = std::numeric_limits<int>::max();
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < faces.shape(0); ++i) {
    const Vec3 corners = Vec3::from(faces.data() + 3 * i);
    for (const double index : corners) {
      if (index == std::floor(index) && std::abs(index) <= kMost) continue;
      std::ostringstream message;
      message << "mesh: triangle " << i << " names vertex " << index
              << "; indices are whole numbers from 0 on";
      throw std::invalid_argument(message.str());
    }
    triangles.push_back(
        {static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2])});
  }
  return triangles;
}

void bind_mesh(nb::module_& m) {
  nb::class_<Mesh> type(
      m, "Mesh", R"(Solid 'mesh': the inside of a closed oriented triangle mesh, in its own frame.

The triangles are taken as given, not their hull; cavities and several parts are welcome. Equal
vertices are welded. A mesh that is inside out as a whole is turned: see `turned`. Parts that
overlap each other count twice.)");
  type.def(
      "__init__",
      [](Mesh* self, const nb::object& given_vertices, const nb::object& given_faces) {
        const auto vertices =
            rows_from(given_vertices, "mesh: vertices must be an array of numbers, shape (n, 3)");
        const std::vector<Vec3> points = points_from(vertices);
        new (self) Mesh(points, triangles_from(given_faces));
      },
      nb::arg("vertices"), nb::arg("faces"),
      nb::sig("def __init__(self, vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, "
              "3), order='C')], faces: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), "
              "order='C')]) -> None"),
      "vertices [m], shape (n, 3); faces: indices of vertices from 0, counterclockwise seen from "
      "outside, shape (m, 3). Raises ValueError when they bound no solid, and says where");
  def_solid(type);
  const auto vertices = [](const Mesh& self) {
    const std::vector<Vec3>& points = self.topology().vertices;
    return new_array<double, nb::shape<-1, 3>>({points.size(), 3}, [&points](double* numbers) {
      for (std::size_t i = 0; i < points.size(); ++i) points[i].to(numbers + 3 * i);
    });
  };
  const auto faces = [](const Mesh& self) {
    const std::vector<Triangle>& triangles = self.topology().triangles;
    return new_array<int, nb::shape<-1, 3>>({triangles.size(), 3}, [&triangles](int* numbers) {
      for (const Triangle& triangle : triangles) {
        numbers = std::copy(triangle.begin(), triangle.end(), numbers);
      }
    });
  };
  constexpr auto kOwn = nb::rv_policy::reference;  // the arrays have an owner
  type.def_prop_ro("vertices", vertices, kOwn, "Corners after welding [m], shape (n, 3)")
      .def_prop_ro("faces", faces, kOwn, "Triangles after welding, shape (m, 3)")
      .def_prop_ro(
          "turned", [](const Mesh& self) { return self.topology().turned; },
          "Whether all triangles pointed inwards and were turned")
      .def_prop_ro(
          "parts", [](const Mesh& self) { return self.topology().component_count; },
          "How many connected surfaces it has")
      .def("__repr__", [](const Mesh& self) {
        return "Mesh(" + std::to_string(self.topology().vertices.size()) + " vertices, " +
               std::to_string(self.topology().triangles.size()) + " faces)";
      });
}

}  // namespace

void bind_shapes(nb::module_& m) {
  bind_csg(m);
  bind_mesh(m);
  for_each_type(SimpleShapes{}, [&](auto tag) {
    using Solid = typename decltype(tag)::Type;
    nb::class_<Solid> type(m, camel_case(Solid::kName).c_str(), shape_doc<Solid>().c_str());
    def_init<Solid>(type);
    def_solid(type);
    type.def(
            "support", [](const Solid& self, const Vec3& e) { return self.support(e); },
            nb::arg("direction"), "A point of the solid farthest along the direction [m]")
        .def("__repr__", [](const Solid& self) { return shape_text(self); });
  });
}

}  // namespace volcontact::python
