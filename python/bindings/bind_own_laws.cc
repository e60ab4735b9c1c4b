// SPDX-License-Identifier: Apache-2.0
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>

#include "bindings.h"
#include "python_law.h"
#include "volcontact/base/check.h"
#include "volcontact/force/friction.h"
#include "volcontact/force/normal_force.h"

namespace volcontact::python {
namespace {

namespace nb = nanobind;

// What a law in Python raised during the evaluation that runs, which cannot throw.
thread_local std::exception_ptr raised;

using StateRow = std::tuple<std::string, std::string, std::string>;  // name, unit, keeping

Keeping keeping_from(const std::string& word) {
  if (word == "vector") return Keeping::kVector;
  if (word == "amount") return Keeping::kAmount;
  if (word == "vector_value") return Keeping::kVectorValue;
  require(word == "value",
          "keeping '" + word + "' must be one of vector, amount, value, vector_value");
  return Keeping::kValue;
}

std::string type_of(const nb::handle& value) {
  return value.is_none() ? "None" : "a " + nb::cast<std::string>(nb::type_name(value.type()));
}

// What a law gave, for messages: "own_law: magnitude".
struct Given {
  const std::string& law;
  std::string what;

  std::string text() const { return law + ": " + what; }

  void require_finite(double number, const char* unit) const {
    if (std::isfinite(number)) return;
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g", number);
    throw std::invalid_argument(text() + " = " + digits + " [" + unit +
                                "]; evaluate must give finite numbers");
  }

  template <typename T>
  T as(const nb::handle& value, const char* wanted) const {
    T out;
    if (!value.is_none() && nb::try_cast<T>(value, out)) return out;
    throw nb::type_error((text() + " is " + type_of(value) + "; it must be " + wanted).c_str());
  }
};

void check(const std::string& law, const NormalOutput& out) {
  Given{law, "magnitude"}.require_finite(out.magnitude, "N");
  Given{law, "elastic"}.require_finite(out.elastic, "N");
  Given{law, "elastic_energy"}.require_finite(out.elastic_energy, "J");
  Given{law, "rolling_damping"}.require_finite(out.rolling_damping, "N s/m^4");
}

void check(const std::string& law, const FrictionOutput& out) {
  for (const int i : {0, 1, 2}) {
    Given{law, "force[" + std::to_string(i) + "]"}.require_finite(out.force[i], "N");
  }
  Given{law, "torque"}.require_finite(out.torque, "N m");
  Given{law, "slide_energy"}.require_finite(out.slide_energy, "J");
  Given{law, "spin_energy"}.require_finite(out.spin_energy, "J");
  Given{law, "slide_power"}.require_finite(out.slide_power, "W");
  Given{law, "spin_power"}.require_finite(out.spin_power, "W");
}

constexpr const char* output_name(const NormalOutput*) { return "a NormalOutput"; }
constexpr const char* output_name(const FrictionOutput*) { return "a FrictionOutput"; }

// The table of states of a law, and the numbers of a site as a dict of its names.
class StateTable {
 public:
  explicit StateTable(const std::vector<StateRow>& rows) : rows_(rows) {
    for (const auto& [name, unit, keeping] : rows_) {
      fields_.push_back({name.c_str(), unit.c_str(), keeping_from(keeping), ""});
    }
  }
  StateTable(const StateTable&) = delete;
  StateTable& operator=(const StateTable&) = delete;

  std::span<const StateField> fields() const { return fields_; }

  nb::dict read(const double* numbers) const {
    nb::dict state;
    for (const StateField& field : fields_) {
      if (field.size() == 3) {
        state[field.name] = Vec3(numbers[0], numbers[1], numbers[2]);
      } else {
        state[field.name] = *numbers;
      }
      numbers += field.size();
    }
    return state;
  }

  void write(const std::string& law, const nb::dict& state, double* numbers) const {
    require(state.size() == fields_.size(), law + ": a law must not add or remove states");
    for (const StateField& field : fields_) {
      const Given given{law, std::string("state '") + field.name + "'"};
      require(state.contains(field.name), given.text() + " is missing; a law must not remove it");
      const nb::object value = state[field.name];
      if (field.size() == 3) {
        const Vec3 vector = given.as<Vec3>(value, "three numbers");
        std::copy_n(vector.data(), 3, numbers);
      } else {
        *numbers = given.as<double>(value, "a number");
      }
      for (int i = 0; i < field.size(); ++i) given.require_finite(numbers[i], field.unit);
      numbers += field.size();
    }
  }

 private:
  std::vector<StateRow> rows_;
  std::vector<StateField> fields_;
};

// A law whose `evaluate` is Python. It takes the interpreter lock at every site.
template <typename Base, typename Input, typename Output>
class PythonLaw final : public Base {
 public:
  PythonLaw(std::string name, const std::vector<StateRow>& states)
      : name_(std::move(name)), table_(states) {}

  const char* name() const noexcept override { return name_.c_str(); }
  std::span<const StateField> states() const noexcept override { return table_.fields(); }

  Output evaluate(const Input& in, const LawState& state) const noexcept override {
    const nb::gil_scoped_acquire lock;
    if (raised) return {};
    try {
      const nb::object self = nb::find(*this);
      const nb::dict numbers = table_.read(state.committed);
      const nb::object out = self.attr("evaluate")(in, numbers, state.elapsed);
      table_.write(name_, numbers, state.pending);
      const Output given = Given{name_, "what evaluate returned"}.as<Output>(
          out, output_name(static_cast<const Output*>(nullptr)));
      check(name_, given);
      return given;
    } catch (...) {
      raised = std::current_exception();
      return {};
    }
  }

 private:
  std::string name_;
  StateTable table_;
};

using PythonNormal = PythonLaw<NormalForce, NormalInput, NormalOutput>;
using PythonFriction = PythonLaw<Friction, FrictionInput, FrictionOutput>;

void bind_inputs(nb::module_& m) {
  nb::class_<NormalInput>(m, "NormalInput", "All a normal law knows of a contact site.")
      .def_ro("volume", &NormalInput::volume, "V [m^3]")
      .def_ro("depth_moment", &NormalInput::depth_moment, "int L^2/2 dA [m^4]")
      .def_ro("approach_speed", &NormalInput::approach_speed, "> 0 while approaching [m/s]")
      .def_ro("mass", &NormalInput::mass, "Reduced mass of the bodies, 0 where not known [kg]");
  nb::class_<Patch>(m, "Patch", "The contact patch as a friction law sees it.")
      .def_ro("gyration_radius", &Patch::gyration_radius, "[m]")
      .def_ro("volume", &Patch::volume, "[m^3]")
      .def_ro("area", &Patch::area, "Projected along the normal [m^2]")
      .def_ro("second_moment", &Patch::second_moment, nb::rv_policy::copy,
              "int r r^T dV about the centroid [m^5], shape (3, 3)");
  nb::class_<FrictionInput>(m, "FrictionInput",
                            "All a friction law knows of a contact site; world frame.")
      .def_ro("normal_force", &FrictionInput::normal_force, "[N]")
      .def_ro("normal", &FrictionInput::normal, nb::rv_policy::copy, "On A, shape (3,)")
      .def_ro("slip", &FrictionInput::slip, nb::rv_policy::copy,
              "Tangential velocity of A against B at the centroid [m/s], shape (3,)")
      .def_ro("spin", &FrictionInput::spin, "Of A against B about the normal [rad/s]")
      .def_ro("travel", &FrictionInput::travel, nb::rv_policy::copy,
              "Way of A against B since the committed time [m], shape (3,)")
      .def_ro("turn", &FrictionInput::turn, "About the normal since then [rad]")
      .def_ro("patch", &FrictionInput::patch, nb::rv_policy::copy)
      .def_ro("normal_stiffness", &FrictionInput::normal_stiffness,
              "Elastic part of the normal force per depth V/|S| [N/m]")
      .def_ro("mass", &FrictionInput::mass, "Reduced mass of the bodies, 0 where not known [kg]");
}

void bind_outputs(nb::module_& m) {
  nb::class_<NormalOutput>(m, "NormalOutput", "What a normal law returns.")
      .def(
          "__init__",
          [](NormalOutput* self, double magnitude, double elastic, double elastic_energy,
             double rolling_damping) {
            new (self) NormalOutput{magnitude, elastic, elastic_energy, rolling_damping};
          },
          nb::kw_only(), nb::arg("magnitude"), nb::arg("elastic"), nb::arg("elastic_energy"),
          nb::arg("rolling_damping") = 0.0,
          R"(Args:
    magnitude [N]: f_n, >= 0
    elastic [N]: the part of it that is stored
    elastic_energy [J]: what is stored
    rolling_damping [N s/m^4]: torque per rolling speed and second moment of the volume)");
  nb::class_<FrictionOutput>(m, "FrictionOutput", "What a friction law returns.")
      .def(
          "__init__",
          [](FrictionOutput* self, const Vec3& force, double torque, double slide_energy,
             double spin_energy, double slide_power, double spin_power) {
            new (self)
                FrictionOutput{force, torque, slide_energy, spin_energy, slide_power, spin_power};
          },
          nb::kw_only(), nb::arg("force"), nb::arg("torque") = 0.0, nb::arg("slide_energy") = 0.0,
          nb::arg("spin_energy") = 0.0, nb::arg("slide_power"), nb::arg("spin_power") = 0.0,
          R"(Args:
    force [N]: on A, tangential, shape (3,)
    torque [N m]: on A, about the normal
    slide_energy, spin_energy [J]: stored in deflection and in twist
    slide_power, spin_power [W]: dissipated: work done against friction less what is being stored)");
}

template <typename Law, typename Base>
void bind_python_law(nb::module_& m, const char* name, const char* what) {
  nb::class_<Law, Base>(m, name, what)
      .def(
          "__init__",
          [](Law* self, const std::string& law, const std::vector<StateRow>& states) {
            new (self) Law(law, states);
          },
          nb::arg("name"), nb::arg("states"));
}

}  // namespace

void rethrow_law_error() {
  if (raised) std::rethrow_exception(std::exchange(raised, nullptr));
}

void bind_own_laws(nb::module_& m) {
  bind_inputs(m);
  bind_outputs(m);
  bind_python_law<PythonNormal, NormalForce>(m, "PythonNormal", "Base of vc.NormalLaw.");
  bind_python_law<PythonFriction, Friction>(m, "PythonFriction", "Base of vc.FrictionLaw.");
}

}  // namespace volcontact::python
