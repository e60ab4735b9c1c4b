// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <memory>

#include "arrays.h"
#include "bindings.h"
#include "python_distance.h"
#include "signals.h"
#include "volcontact/pair/interference.h"

namespace volcontact::python {
namespace {

namespace nb = nanobind;

// What Python gets: the sum as the object itself, its sites beside it.
struct InterferenceMetrics : VolumeMetrics {
  std::vector<VolumeMetrics> sites;
  Engine engine = Engine::kAuto;
};

// What an evaluation writes to, reused from call to call.
struct Memory {
  InterferenceWorkspace workspace;
  Interference out;
};

InterferenceMetrics compute(const Shape& a, const Shape& b, const std::optional<Matrix4>& X_AB,
                            double tolerance, const std::string& engine, int threads) {
  require(tolerance > 0.0 && tolerance < 1.0,
          "interference: tolerance = " + std::to_string(tolerance) + " must be > 0 and < 1");
  require(threads >= 0,
          "interference: threads = " + std::to_string(threads) + " must be >= 0 (0 = by work)");
  const InterferenceOptions options{tolerance, engine_from(engine), threads};
  require(serves(options.engine, a, b), std::string("engine ") + engine +
                                            " does not serve the pair " + name_of(a) + " - " +
                                            name_of(b) + "; use auto or octree");
  const Pose pose = pose_from(X_AB, "X_AB");
  // A callable that the octree calls may ask in turn, and then finds no spare memory.
  thread_local std::unique_ptr<Memory> spare;
  std::unique_ptr<Memory> memory = spare ? std::move(spare) : std::make_unique<Memory>();
  clear_distance_error();
  {
    const nb::gil_scoped_release release;
    const SignalScope signals;
    interference(a, b, pose, options, memory->workspace, memory->out);
  }
  rethrow_distance_error();
  const Interference& out = memory->out;
  InterferenceMetrics metrics{out.total, out.sites, out.engine};
  spare = std::move(memory);
  return metrics;
}

}  // namespace

void bind_interference(nb::module_& m) {
  nb::class_<InterferenceMetrics, VolumeMetrics>(
      m, "Interference", "Metrics of a whole overlap and, in `sites`, of each connected region.")
      .def_ro("sites", &InterferenceMetrics::sites, "One VolumeMetrics a contact site")
      .def_prop_ro(
          "engine", [](const InterferenceMetrics& self) { return to_string(self.engine); },
          "The engine that made the numbers");

  m.def("interference", &compute, nb::arg("a"), nb::arg("b"), nb::arg("X_AB") = nb::none(),
        nb::kw_only(), nb::arg("tolerance") = 1e-3, nb::arg("engine") = "auto",
        nb::arg("threads") = 1,
        R"(Interference volume of two solids, in A's frame and about its origin.

Args:
    a: solid A
    b: solid B
    X_AB: pose of B in A, shape (4, 4); the identity when left out
    tolerance [-]: relative error asked of the volume, between 0 and 1
    engine: 'auto', 'closed_form', 'clip', 'lines', 'surface_sweep', 'columns' or 'octree'
    threads: threads for this one pair, 0 = decide by work; never changes a bit

Returns:
    Interference: the metrics; `volume` is 0 when the solids are apart

Raises:
    ValueError: X_AB is no pose, a value is out of range, the engine does not serve the pair, or a
        SignedDistance returned no numbers of the right shape
    whatever a SignedDistance raised itself, and KeyboardInterrupt where Ctrl-C ends it)");
}

}  // namespace volcontact::python
