// SPDX-License-Identifier: Apache-2.0
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bindings.h"
#include "python_distance.h"
#include "volcontact/shape/signed_distance.h"

namespace volcontact::python {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

using Corners = Matrix<2, 3>;
using TwoCorners = std::array<std::array<double, 3>, 2>;  // from any sequences
// Any number of axes: a wrong one is told with the shape.
using Distances = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Points = nb::ndarray<nb::numpy, double, nb::ndim<2>, nb::c_contig>;

// The octree calls from the thread that asked, and lets no exception through: it waits here.
thread_local std::exception_ptr first_error;

std::string shape_text(const nb::object& array) {
  return nb::cast<std::string>(nb::str(nb::object(array.attr("shape"))));
}

// A callable from points (n, 3) to distances (n,).
class PythonSource final : public SignedDistance::Source {
 public:
  PythonSource(nb::object callable, const Aabb& bounds)
      : callable_(std::move(callable)), bounds_(bounds) {}
  ~PythonSource() override {
    nb::gil_scoped_acquire lock;
    callable_.reset();
  }
  PythonSource(const PythonSource&) = delete;
  PythonSource& operator=(const PythonSource&) = delete;

  Aabb bounds() const override { return bounds_; }
  bool serves_steps() const override { return false; }

  void evaluate(const Vec3* points, int count, double* distances) const noexcept override {
    if (!first_error) {
      nb::gil_scoped_acquire lock;
      try {
        return call(points, static_cast<std::size_t>(count), distances);
      } catch (...) {
        first_error = std::current_exception();
      }
    }
    std::fill_n(distances, count, kInfinity);  // outside: comes to an end soon
  }

  const nb::object& callable() const { return callable_; }
  /// For the garbage collector: nobody can reach the solid any more.
  void forget_callable() const { callable_.reset(); }

 private:
  void call(const Vec3* points, std::size_t count, double* distances) const {
    require(callable_.is_valid(), "signed_distance: the callable is gone");
    auto* copy = new double[3 * count];  // the callable may keep what it gets
    nb::capsule owner(copy, [](void* p) noexcept { delete[] static_cast<double*>(p); });
    std::memcpy(copy, points->data(), 3 * count * sizeof(double));
    Points array(copy, {count, 3}, owner);
    const nb::object result = nb::module_::import_("numpy").attr("asarray")(
        callable_(nb::cast(array)), "dtype"_a = "float64", "order"_a = "C");
    const auto values = nb::cast<Distances>(result);
    require(
        values.ndim() == 1 && values.shape(0) == count,
        "signed_distance: the callable must return shape (n,) for points of shape (n, 3), got " +
            shape_text(result) + " for n = " + std::to_string(count));
    for (std::size_t i = 0; i < count; ++i) {
      const double value = distances[i] = values.data()[i];
      require(std::isfinite(value),
              "signed_distance: the callable returned " + std::to_string(value) + " at (" +
                  std::to_string(points[i].x()) + ", " + std::to_string(points[i].y()) + ", " +
                  std::to_string(points[i].z()) + ")");
    }
  }

  mutable nb::object callable_;
  Aabb bounds_;
};

// A callable that refers to its own solid is a cycle: the garbage collector must see it.
const PythonSource* source_of(PyObject* self) {
  if (!nb::inst_ready(self)) return nullptr;
  return dynamic_cast<const PythonSource*>(&nb::inst_ptr<SignedDistance>(self)->source());
}
int traverse(PyObject* self, visitproc visit, void* arg) {
  if (const PythonSource* source = source_of(self)) Py_VISIT(source->callable().ptr());
  Py_VISIT(Py_TYPE(self));
  return 0;
}
int clear(PyObject* self) {
  if (const PythonSource* source = source_of(self)) source->forget_callable();
  return 0;
}
PyType_Slot kCollectable[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse)},
                              {Py_tp_clear, reinterpret_cast<void*>(clear)},
                              {0, nullptr}};

}  // namespace

void clear_distance_error() { first_error = nullptr; }

void rethrow_distance_error() {
  if (first_error) std::rethrow_exception(std::exchange(first_error, nullptr));
}

void bind_signed_distance(nb::module_& m) {
  nb::class_<SignedDistance>(m, "SignedDistance", nb::type_slots(kCollectable),
                             R"(Solid given by a Python callable, for vc.interference only.

The callable gets points [m], shape (n, 3), in the solid's frame, and returns their signed distances
[m], shape (n,): negative inside. It need not be the true distance, only no steeper than `lipschitz`.
It is called once for each batch of cells.

A contact model or a scene is stepped without the interpreter lock and takes no such solid; write it
in C++ for that (docs/theory.md, 'Solids with a signed distance').

Args:
    distance: the callable
    bounds [m]: a box that holds the solid, shape (2, 3), the lower corner first
    lipschitz [-]: nowhere is the function steeper; > 0
    curvature [1/m]: bound of its second derivatives in any direction, where the function is below
        lipschitz^2 / (2 curvature) in magnitude; >= 0; a ball of radius r has 1.5/r. With it the
        certified bounds are of second order and meet a per cent; without it of first order,
        and the status is 'approximate' below a few per cent, though the volume itself is better)")
      .def(
          "__init__",
          [](SignedDistance* self, nb::object distance, const TwoCorners& bounds, double lipschitz,
             std::optional<double> curvature) {
            if (!PyCallable_Check(distance.ptr())) {
              throw nb::type_error("SignedDistance: distance must be callable");
            }
            const Aabb box{Vec3::from(bounds[0].data()), Vec3::from(bounds[1].data())};
            new (self) SignedDistance(std::make_shared<const PythonSource>(distance, box),
                                      {lipschitz, curvature.value_or(kInfinity)});
          },
          "distance"_a, "bounds"_a, nb::kw_only(), "lipschitz"_a = 1.0, "curvature"_a = nb::none(),
          nb::sig("def __init__(self, distance: "
                  "collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], "
                  "numpy.typing.ArrayLike], bounds: "
                  "collections.abc.Sequence[collections.abc.Sequence[float]], *, lipschitz: float "
                  "= 1.0, curvature: float | None = None) -> None"))
      .def_prop_ro(
          "bounds",
          [](const SignedDistance& self) {
            Corners corners;
            corners.set_row(0, self.bounds().min);
            corners.set_row(1, self.bounds().max);
            return corners;
          },
          "[m], shape (2, 3), the lower corner first")
      .def(
          "signed_distance",
          [](const SignedDistance& self, const Vec3& point) {
            clear_distance_error();
            const double distance = self.signed_distance(point);
            rethrow_distance_error();
            return distance;
          },
          "point"_a, "What the callable says there, over `lipschitz` [m]")
      .def("__repr__", [](const SignedDistance& self) {
        const auto* source = dynamic_cast<const PythonSource*>(&self.source());
        return "SignedDistance(" +
               (source ? nb::cast<std::string>(nb::repr(source->callable())) : std::string("?")) +
               ")";
      });
}

}  // namespace volcontact::python
