// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adaptor/support/models.h"
#include "core/support/random.h"

namespace volcontact::adaptor::testing {

inline std::string keys(const std::string& mode, const std::string& friction,
                        const std::string& stiffness,
                        const std::vector<std::string>& geoms = {"floor", "low", "high", "hand"}) {
  return numeric("volcontact/option/implicit/" + mode, "1") +
         numeric("volcontact/material/m/friction_law/" + friction, "1") +
         material("m", {{"stiffness", stiffness}, {"damping", "0.3"}, {"friction", "0.4"}}, geoms);
}

// A box on a floor, one on it, and the hand of a jointed arm on that, driven by a servo. `joints`:
// more attributes of the three joints.
inline std::string bodies(const std::string& option, double joint_damping, const std::string& keys,
                          const std::string& joints = "") {
  const std::string damping = " damping=\"" + std::to_string(joint_damping) + "\" " + joints + "/>";
  return "<mujoco><option timestep=\"2e-3\" " + option +
         "/><worldbody><geom name=\"floor\" type=\"plane\" size=\"2 2 .1\"/>"
         "<body name=\"low\" pos=\"0 0 .099\"><freejoint/>"
         "<geom name=\"low\" type=\"box\" size=\".15 .12 .1\" mass=\"3\"/></body>"
         "<body name=\"high\" pos=\".02 .01 .248\"><freejoint/>"
         "<geom name=\"high\" type=\"box\" size=\".08 .1 .05\" mass=\"1\"/></body>"
         "<body pos=\".5 0 .29\"><joint name=\"lift\" axis=\"0 1 0\"" +
         damping + "<geom type=\"sphere\" size=\".02\" mass=\"2\" pos=\"-.2 0 0\" contype=\"0\" " +
         "conaffinity=\"0\"/><body pos=\"-.3 0 0\"><joint name=\"elbow\" axis=\"0 1 0\"" + damping +
         "<joint type=\"slide\" axis=\"0 1 0\"" + damping +
         "<geom name=\"hand\" type=\"box\" size=\".1 .03 .02\" pos=\"-.15 0 .026\" mass=\"1\" "
         "euler=\"3 2 0\"/></body></body></worldbody>"
         "<actuator><position joint=\"lift\" kp=\"50\"/></actuator>" +
         keys + "</mujoco>";
}

inline void scatter(const ModelPointer& m, const DataPointer& d, std::uint64_t seed) {
  volcontact::test::Random random(seed);
  for (int i = 0; i < m->nv; ++i) d->qvel[i] = random.uniform(-0.5, 0.5);
  for (const int body : {0, 7}) {
    d->qpos[body + 2] -= random.uniform(0.0, 2e-3);
    for (int i = 4; i < 7; ++i) d->qpos[body + i] = random.uniform(-0.01, 0.01);
    mju_normalize4(d->qpos + body + 3);
  }
  d->ctrl[0] = random.uniform(-1.0, 1.0);
  for (int i = 0; i < m->nv; ++i) d->qfrc_applied[i] = random.uniform(-5.0, 5.0);
  for (int i = 6; i < 6 * m->nbody; ++i) d->xfrc_applied[i] = random.uniform(-1.0, 1.0);
}

}  // namespace volcontact::adaptor::testing
