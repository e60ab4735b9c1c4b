// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "bindings.h"
#include "python_law.h"
#include "signals.h"
#include "volcontact/model/contact_model.h"
#include "volcontact/model/contact_tangent.h"
#include "volcontact/model/model_text.h"

namespace volcontact::python {
namespace {

namespace nb = nanobind;

using NormalPtr = std::shared_ptr<const NormalForce>;
using FrictionPtr = std::shared_ptr<const Friction>;

struct PyReport : ContactReport {
  int row_size = 0;
  std::optional<ContactTangent> tangent;

  VolumeMetrics metrics() const {
    VolumeMetrics sum;
    for (const SiteReport& site : sites) sum = sum + site.metrics;
    return sum;
  }
  auto state() const {
    const auto stride = static_cast<std::size_t>(row_size);
    return new_array<double, nb::ndim<2>>(
        {stride > 0 ? memory.size() / stride : 0, stride},
        [this](double* numbers) { std::copy(memory.begin(), memory.end(), numbers); });
  }
};

PyReport evaluate(const ContactModel& model, const std::optional<Matrix4>& X_WA,
                  const std::optional<Matrix4>& X_WB, const std::optional<Vector6>& V_WA,
                  const std::optional<Vector6>& V_WB, const std::optional<Rows>& state,
                  double elapsed, bool tangent) {
  PyReport report;
  report.row_size = model.row_size();
  report.keeps_inputs = tangent;
  const std::size_t columns = state ? state->shape(1) : 0;
  require(!state || columns == static_cast<std::size_t>(report.row_size),
          "evaluate: the rows of state have " + std::to_string(columns) +
              " numbers, those of the model have " + std::to_string(report.row_size));
  require(elapsed >= 0.0, "evaluate: elapsed must be >= 0 s");
  const BodyMotion motion{pose_from(X_WA, "X_WA"), pose_from(X_WB, "X_WB"),
                          twist_from(V_WA, "V_WA"), twist_from(V_WB, "V_WB")};
  SiteMemory memory;
  if (state) memory = {state->data(), static_cast<int>(state->shape(0)), model.row_size(), 0.0};
  memory.elapsed = elapsed;
  thread_local ContactModel::Workspace workspace;
  {
    const nb::gil_scoped_release release;
    const SignalScope signals;
    model.evaluate(motion, memory, workspace, report);
    if (tangent) report.tangent = contact_tangent(model, report);
  }
  rethrow_law_error();
  return report;
}

ContactModel make_model(const std::vector<GeometricPair>& pairs, const NormalPtr& normal,
                        const FrictionPtr& friction, bool rolling, double tolerance,
                        const std::string& engine, int threads, const std::string& formulation,
                        double share_of_a, double mass) {
  require(tolerance > 0.0 && tolerance < 1.0,
          "contact_model: tolerance = " + std::to_string(tolerance) + " must be > 0 and < 1");
  return ContactModel(pairs,
                      {normal, friction, rolling, formulation_from(formulation), share_of_a, mass},
                      {tolerance, engine_from(engine), threads});
}

// A contact model runs without the interpreter lock, as a time step must.
void require_no_python(const Shape& shape) {
  const auto* solid = std::get_if<SignedDistance>(&shape);
  require(!solid || solid->source().serves_steps(),
          "Pair: a SignedDistance with a Python callable serves vc.interference only, since a "
          "contact model is evaluated without Python's lock; write that solid in C++, or compose "
          "it of shapes");
}

// A law in Python may lead back to the model, through its class and the module of that.
int traverse_model(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  const ContactLaws& laws = nb::inst_ptr<ContactModel>(self)->laws();
  const nb::handle normal = nb::find(laws.normal), friction = nb::find(laws.friction);
  Py_VISIT(normal.ptr());
  Py_VISIT(friction.ptr());
  return 0;
}
PyType_Slot model_slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(&traverse_model)},
                             {0, nullptr}};

void bind_report(nb::module_& m) {
  nb::class_<ByChannel>(m, "ByChannel", "One number for each way in which a contact dissipates.")
      .def_ro("normal", &ByChannel::normal)
      .def_ro("roll", &ByChannel::roll)
      .def_ro("slide", &ByChannel::slide)
      .def_ro("spin", &ByChannel::spin)
      .def_prop_ro("sum", &ByChannel::sum);
  nb::class_<SiteReport>(m, "SiteReport", "One contact site, in the world frame.")
      .def_ro("pair", &SiteReport::pair, "Index of the geometric pair")
      .def_ro("metrics", &SiteReport::metrics, nb::rv_policy::copy, "About the world origin")
      .def_ro("normal", &SiteReport::normal, nb::rv_policy::copy, "On A, from B to A, shape (3,)")
      .def_ro("normal_force", &SiteReport::normal_force, "[N]")
      .def_ro("force_on_A", &SiteReport::force_on_A, nb::rv_policy::copy,
              "Normal force and friction, at the centroid [N], shape (3,)")
      .def_ro("torque_on_A", &SiteReport::torque_on_A, nb::rv_policy::copy,
              "Rolling and spin torque, about the centroid [N m], shape (3,)")
      .def_ro("approach_speed", &SiteReport::approach_speed, "> 0 while approaching [m/s]")
      .def_ro("slip", &SiteReport::slip, nb::rv_policy::copy,
              "Tangential velocity of A against B at the centroid [m/s], shape (3,)")
      .def_ro("spin", &SiteReport::spin, "Of A against B about the normal [rad/s]")
      .def_ro("elastic_energy", &SiteReport::elastic_energy, "Of the volume and the bristles [J]")
      .def_ro("bristle_energy", &SiteReport::bristle_energy, nb::rv_policy::copy,
              "The part of it that sliding and spinning stored [J]")
      .def_ro("power", &SiteReport::power, nb::rv_policy::copy, "Dissipated [W]");
  nb::class_<ContactTangent>(
      m, "ContactTangent",
      "How the wrenches change with the motion: rows are the torque and force on A, then those on "
      "B; "
      "columns the turn [rad] and displacement [m] of A's frame, then of B's, or their speeds.")
      .def_ro("by_motion", &ContactTangent::by_motion, nb::rv_policy::copy,
              "Analytic, of a flat patch, at fixed states, shape (12, 12)")
      .def_ro("by_speed", &ContactTangent::by_speed, nb::rv_policy::copy, "Shape (12, 12)");
  nb::class_<PyReport>(m, "ContactReport", "What an evaluation of a contact model returns.")
      .def_prop_ro("metrics", &PyReport::metrics, "Sum over all sites, in the world frame")
      .def_ro("sites", &PyReport::sites)
      .def_prop_ro(
          "force_on_A", [](const PyReport& r) { return r.wrench_on_A().force; },
          "[N], shape (3,), world frame")
      .def_prop_ro(
          "torque_on_A", [](const PyReport& r) { return r.wrench_on_A().torque; },
          "About A's origin [N m], shape (3,), world frame")
      .def_prop_ro(
          "force_on_B", [](const PyReport& r) { return r.wrench_on_B().force; },
          "[N], shape (3,), world frame")
      .def_prop_ro(
          "torque_on_B", [](const PyReport& r) { return r.wrench_on_B().torque; },
          "About B's origin [N m], shape (3,), world frame")
      .def_prop_ro("touching", &PyReport::touching)
      .def_ro("elastic_energy", &PyReport::elastic_energy, "[J]")
      .def_ro("power", &PyReport::power, nb::rv_policy::copy, "Dissipated [W]")
      .def_ro("tangent", &PyReport::tangent, "None unless it was asked for")
      .def_prop_ro("state", &PyReport::state, nb::rv_policy::reference,
                   "What the sites keep for the next evaluation, shape (sites, row_size)");
}

}  // namespace

void bind_model(nb::module_& m) {
  nb::class_<GeometricPair>(m, "Pair", "A solid fixed on body A and a solid fixed on body B.")
      .def(
          "__init__",
          [](GeometricPair* self, const Shape& a, const Shape& b,
             const std::optional<Matrix4>& X_Aa, const std::optional<Matrix4>& X_Bb) {
            require_no_python(a);
            require_no_python(b);
            new (self) GeometricPair{a, b, pose_from(X_Aa, "X_Aa"), pose_from(X_Bb, "X_Bb")};
          },
          nb::arg("a"), nb::arg("b"), nb::kw_only(), nb::arg("X_Aa") = nb::none(),
          nb::arg("X_Bb") = nb::none(),
          "X_Aa, X_Bb: poses of the solids in their bodies, shape (4, 4)");
  bind_report(m);
  nb::class_<ContactModel>(
      m, "ContactModel",
      "Geometric pairs x normal law x friction law: the CSA paper's contact model container.",
      nb::type_slots(model_slots))
      .def(
          "__init__",
          [](ContactModel* self, const std::vector<GeometricPair>& pairs, const NormalPtr& normal,
             const FrictionPtr& friction, bool rolling, double tolerance, const std::string& engine,
             int threads, const std::string& formulation, double share_of_a, double mass) {
            new (self) ContactModel(make_model(pairs, normal, friction, rolling, tolerance, engine,
                                               threads, formulation, share_of_a, mass));
          },
          nb::kw_only(), nb::arg("pairs"), nb::arg("normal"), nb::arg("friction") = nb::none(),
          nb::arg("rolling") = true, nb::arg("tolerance") = 1e-3, nb::arg("engine") = "auto",
          nb::arg("threads") = 1, nb::arg("formulation") = "gonthier", nb::arg("share_of_a") = 0.5,
          nb::arg("mass") = 0.0,
          R"(Const once made.

Args:
    pairs, normal, friction, rolling: the solids and the laws
    tolerance [-], engine, threads: as in `interference`
    formulation: 'gonthier', k V along the area vector at the centroid of the volume, or
        'potential', the gradient of int min(p_A, p_B) dV: conservative for every pair it takes
    share_of_a [-]: share of the compliance 1/k_v that is A's layer, 0 to 1; for 'potential'
    mass [kg]: reduced mass of the two bodies, 1 / (1/m_A + 1/m_B), of which sticking friction
        takes its damping and a restitution the speed of a blow; 0: not known

Raises:
    ValueError: a forced engine or the formulation does not serve a pair)")
      .def_prop_ro("row_size", &ContactModel::row_size,
                   "Numbers kept for each contact site; 0 when the laws keep nothing")
      .def_prop_ro(
          "text", [](const ContactModel& model) { return text_of(model); },
          "All of it as text, as the C container reads it (docs/c_container.md). Raises ValueError "
          "with a SignedDistance or a law of your own")
      .def("evaluate", &evaluate, nb::kw_only(), nb::arg("X_WA") = nb::none(),
           nb::arg("X_WB") = nb::none(), nb::arg("V_WA") = nb::none(), nb::arg("V_WB") = nb::none(),
           nb::arg("state") = nb::none(), nb::arg("elapsed") = 0.0, nb::arg("tangent") = false,
           R"(Wrenches on both bodies from their poses and twists.

Args:
    X_WA, X_WB: poses of the bodies in the world, shape (4, 4); identity when left out
    V_WA, V_WB: twists, angular [rad/s] then linear [m/s] of the frame origin, world frame,
        shape (6,); zero when left out
    state: `state` of the report of the last accepted time, shape (sites, row_size); left out, all
        sites are new
    elapsed [s]: time since then
    tangent: whether to find how the wrenches change with the motion, for an implicit solver

Returns:
    ContactReport: wrenches, sites, energy, dissipated power and the new state

Raises:
    ValueError: a pose, twist or state is not what it should be)");
}

}  // namespace volcontact::python
