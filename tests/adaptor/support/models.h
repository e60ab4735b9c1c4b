// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adaptor/volcontact_mujoco.h"

namespace volcontact::adaptor::testing {

struct DeleteModel {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
};
struct DeleteData {
  void operator()(mjData* d) const { mj_deleteData(d); }
};
using ModelPointer = std::unique_ptr<mjModel, DeleteModel>;
using DataPointer = std::unique_ptr<mjData, DeleteData>;

/// Compiles MJCF text. By way of a file: every release reads files alike.
inline ModelPointer compile(const std::string& mjcf) {
  const std::string path = ::testing::TempDir() + "adaptor_" + std::to_string(getpid()) + ".xml";
  std::ofstream(path) << mjcf;
  char error[1000] = "";
  ModelPointer m(mj_loadXML(path.c_str(), nullptr, error, sizeof error));
  unlink(path.c_str());
  if (!m) throw std::runtime_error(std::string("the test's MJCF: ") + error);
  return m;
}

/// Compiles MJCF text and makes room for volcontact in userdata.
inline ModelPointer load(const std::string& mjcf) {
  ModelPointer m = compile(mjcf);
  char message[1000] = "";
  if (volcontact_reserve(m.get(), message, sizeof message) < 0) throw std::runtime_error(message);
  return m;
}

inline DataPointer make_data(const ModelPointer& m) { return DataPointer(mj_makeData(m.get())); }

/// Attached while it lives.
class Attached {
 public:
  explicit Attached(const ModelPointer& m) : m_(m.get()) {
    char message[1000] = "";
    if (volcontact_attach(m_, message, sizeof message) < 0) throw std::runtime_error(message);
  }
  ~Attached() { volcontact_detach(m_, nullptr, 0); }
  Attached(const Attached&) = delete;
  Attached& operator=(const Attached&) = delete;

 private:
  mjModel* m_;
};

/// <custom> with one material for the geoms named, `keys` after its name: {{"stiffness", "1e8"}}.
inline std::string material(const std::string& name,
                            const std::vector<std::pair<std::string, std::string>>& keys,
                            const std::vector<std::string>& geoms) {
  std::string text = "<custom>";
  for (const auto& [key, data] : keys) {
    text +=
        "<numeric name=\"volcontact/material/" + name + "/" + key + "\" data=\"" + data + "\"/>";
  }
  text += "<tuple name=\"volcontact/material/" + name + "\">";
  for (const std::string& geom : geoms) {
    text += "<element objtype=\"geom\" objname=\"" + geom + "\"/>";
  }
  return text + "</tuple></custom>";
}

/// A numeric below <custom>.
inline std::string numeric(const std::string& name, const std::string& data) {
  return "<custom><numeric name=\"" + name + "\" data=\"" + data + "\"/></custom>";
}

/// A ball of 1 kg, radius 0.05 m, its centre at `height`, over a floor.
inline std::string ball_scene(double height, const std::string& more,
                              const std::string& option = "") {
  return "<mujoco><option timestep=\"1e-4\" " + option +
         "/><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 .1\"/>"
         "<body name=\"ball\" pos=\"0 0 " +
         std::to_string(height) +
         "\"><freejoint/><geom name=\"ball\" type=\"sphere\" size=\".05\" mass=\"1\"/></body>"
         "</worldbody>" +
         more + "</mujoco>";
}

/// Whether `text` has `part` in it, for EXPECT_TRUE.
inline ::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << text << "' does not contain '" << part << "'";
}

/// The message of the exception that `function` throws; empty when it throws none.
template <typename Function>
std::string message_of(Function&& function) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

}  // namespace volcontact::adaptor::testing
