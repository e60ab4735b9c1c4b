// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/interference.h"

#include "volcontact/pair/dispatch.h"
#include "volcontact/pair/engines.h"

namespace volcontact {
namespace {

using Dispatcher = Dispatch<Engines>;

}  // namespace

struct InterferenceWorkspace::Scratch {
  Dispatcher::Scratch of_engines;
};

InterferenceWorkspace::InterferenceWorkspace() : scratch_(std::make_unique<Scratch>()) {}
InterferenceWorkspace::~InterferenceWorkspace() = default;
InterferenceWorkspace::InterferenceWorkspace(InterferenceWorkspace&&) noexcept = default;
InterferenceWorkspace& InterferenceWorkspace::operator=(InterferenceWorkspace&&) noexcept = default;

bool serves(Engine engine, const Shape& a, const Shape& b) {
  return Dispatcher::serves(engine, a, b);
}

Engine engine_for(const Shape& a, const Shape& b) { return Dispatcher::first(a, b); }

void interference(const Shape& a, const Shape& b, const Pose& X_AB,
                  const InterferenceOptions& options, InterferenceWorkspace& workspace,
                  Interference& out) {
  Dispatcher::Scratch& scratch = workspace.scratch().of_engines;
  try {
    Dispatcher::interference(a, b, X_AB, options, scratch, out);
  } catch (...) {
    scratch = Dispatcher::Scratch();  // half grown: lists that belong together differ in length
    throw;
  }
}

}  // namespace volcontact
