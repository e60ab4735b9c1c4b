// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "c_api/guarded.h"
#include "c_api/model.h"
#include "c_api/workspace.h"
#include "volcontact/base/check.h"

using namespace volcontact;
using namespace volcontact::c_api;

namespace {

void copy_channels(const ByChannel& from, double (&to)[4]) {
  const double numbers[] = {from.normal, from.roll, from.slide, from.spin};
  std::copy(std::begin(numbers), std::end(numbers), to);
}

// The rows of a state array. Throws std::invalid_argument where it is of another model.
SiteMemory memory_from(const ContactModel& model, const double* state, int size, double elapsed) {
  SiteMemory memory;
  memory.elapsed = elapsed;
  const int row = model.row_size();
  if (!state || row == 0) return memory;
  check(size >= kStateHead, [&] {
    return std::string("vc_evaluate: state_size = " + std::to_string(size) +
                       " is too small; vc_model_state_size tells the size");
  });
  const double count = state[0];
  if (count == 0.0) return memory;
  check(state[1] == row, [&] {
    return std::string("vc_evaluate: the rows of the state have " + std::to_string(state[1]) +
                       " numbers and those of the model " + std::to_string(row) +
                       "; after a change of the laws start with a state of zeros");
  });
  check(count > 0.0 && count == std::floor(count) && count <= (size - kStateHead) / row, [&] {
    return std::string("vc_evaluate: state[0] = " + std::to_string(count) +
                       " is no count of sites for which state_size = " + std::to_string(size) +
                       " has room");
  });
  memory.rows = state + kStateHead;
  memory.count = static_cast<int>(count);
  memory.stride = row;
  check(std::all_of(memory.rows, memory.rows + static_cast<std::ptrdiff_t>(memory.count) * row,
                    [](double number) { return number - number == 0.0; }),
        [&] { return std::string("vc_evaluate: the state has a number that is not finite"); });
  return memory;
}

// Returns how many rows found no room.
int keep(const ContactReport& report, int row, double* state, int size) {
  if (!state || row == 0) return 0;
  const auto count = static_cast<std::ptrdiff_t>(report.memory.size()) / row;
  const std::ptrdiff_t kept = std::min<std::ptrdiff_t>(count, (size - kStateHead) / row);
  std::copy_n(report.memory.begin(), kept * row, state + kStateHead);
  std::fill(state + kStateHead + kept * row, state + size, 0.0);
  state[0] = static_cast<double>(kept);
  state[1] = row;
  return static_cast<int>(count - kept);
}

vc_site plain(const SiteReport& from) {
  vc_site to{};
  to.metrics = c_api::plain(from.metrics);
  from.normal.to(to.normal);
  to.normal_force = from.normal_force;
  from.force_on_A.to(to.force);
  from.torque_on_A.to(to.torque);
  to.approach_speed = from.approach_speed;
  from.slip.to(to.slip);
  to.spin = from.spin;
  to.elastic_energy = from.elastic_energy;
  copy_channels(from.power, to.power);
  from.metrics.second_moment().to_rows(to.second_moment);
  to.pair = from.pair;
  return to;
}

bool is_finite(const ContactReport& report) {
  const Wrench on_A = report.wrench_on_A(), on_B = report.wrench_on_B();
  const double sum = on_A.force.sum() + on_A.torque.sum() + on_B.force.sum() + on_B.torque.sum() +
                     report.elastic_energy + report.power.sum();
  return sum - sum == 0.0 && std::all_of(report.memory.begin(), report.memory.end(),
                                         [](double number) { return number - number == 0.0; });
}

vc_result plain(const ContactReport& from) {
  vc_result to{};
  const Wrench on_A = from.wrench_on_A(), on_B = from.wrench_on_B();
  on_A.force.to(to.force_on_a);
  on_A.torque.to(to.torque_on_a);
  on_B.force.to(to.force_on_b);
  on_B.torque.to(to.torque_on_b);
  to.elastic_energy = from.elastic_energy;
  copy_channels(from.power, to.power);
  VolumeMetrics sum;
  for (const SiteReport& site : from.sites) sum = sum + site.metrics;
  to.metrics = c_api::plain(sum);
  to.sites = static_cast<int>(from.sites.size());
  return to;
}

}  // namespace

extern "C" {

int vc_workspace_create(vc_workspace** workspace) {
  return guarded([&, function = __func__] {
    require_given(workspace, function, "workspace");
    *workspace = new vc_workspace;
    return 0;
  });
}

void vc_workspace_free(vc_workspace* workspace) { delete workspace; }

int vc_evaluate(const vc_model* model, vc_workspace* workspace, const vc_motion* motion,
                const double* state, double* next_state, int state_size, double elapsed,
                vc_result* result) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require_given(workspace, function, "workspace");
    require_given(motion, function, "motion");
    require_given(result, function, "result");
    check(model->contact.has_value(), [&] {
      return std::string("vc_evaluate: the model has no pairs; add one with vc_model_add_pair");
    });
    check(elapsed >= 0.0 && elapsed - elapsed == 0.0, [&] {
      return std::string("vc_evaluate: elapsed = " + std::to_string(elapsed) + " [s] must be >= 0");
    });
    check(state_size >= 0, [&] {
      return std::string("vc_evaluate: state_size = " + std::to_string(state_size) +
                         " must be >= 0; vc_model_state_size tells the size");
    });
    const ContactModel& contact = *model->contact;
    const int row = contact.row_size();
    check(row == 0 || next_state == nullptr || state_size >= kStateHead, [&] {
      return std::string("vc_evaluate: state_size = " + std::to_string(state_size) +
                         " is too small; vc_model_state_size tells the size");
    });
    const SiteMemory memory = memory_from(contact, state, state_size, elapsed);
    const BodyMotion bodies{pose_from(motion->X_WA, "vc_evaluate: X_WA"),
                            pose_from(motion->X_WB, "vc_evaluate: X_WB"),
                            twist_from(motion->V_WA, "vc_evaluate: V_WA"),
                            twist_from(motion->V_WB, "vc_evaluate: V_WB")};
    ContactReport& report = workspace->report;
    report.keeps_inputs = true;  // for vc_tangent_of
    workspace->model = nullptr;
    contact.evaluate(bodies, memory, workspace->scratch, report);
    if (!is_finite(report)) {
      report.sites.clear();
      *result = {};
      return fail(VC_ERROR_RESULT,
                  "vc_evaluate: a force is no finite number; poses, speeds or parameters are too "
                  "large");
    }
    *result = plain(report);
    workspace->model = &contact;
    result->forgotten = keep(report, row, next_state, state_size);
    return 0;
  });
}

int vc_sites(const vc_workspace* workspace, vc_site* sites, int capacity) {
  return guarded([&, function = __func__] {
    require_given(workspace, function, "workspace");
    const std::vector<SiteReport>& reports = workspace->report.sites;
    const int count = static_cast<int>(reports.size());
    for (int i = 0; sites && i < std::min(capacity, count); ++i) {
      sites[i] = plain(reports[static_cast<std::size_t>(i)]);
    }
    return count;
  });
}

int vc_interference(const vc_solid* a, const vc_solid* b, const double* X_AB, double tolerance,
                    const char* engine, vc_workspace* workspace, vc_metrics* metrics) {
  return guarded([&, function = __func__] {
    require_given(a, function, "a");
    require_given(b, function, "b");
    require_given(workspace, function, "workspace");
    require_given(metrics, function, "metrics");
    check(tolerance > 0.0 && tolerance < 1.0, [&] {
      return "vc_interference: tolerance = " + std::to_string(tolerance) + " must be > 0 and < 1";
    });
    const Engine wanted = engine ? engine_from(engine) : Engine::kAuto;
    const Shape &shape_a = a->named.shape, &shape_b = b->named.shape;
    check(serves(wanted, shape_a, shape_b), [&] {
      return std::string("vc_interference: engine ") + to_string(wanted) + " does not serve " +
             name_of(shape_a) + " with " + name_of(shape_b) + "; use auto or octree";
    });
    Interference& out = workspace->scratch.interference;
    interference(shape_a, shape_b, pose_from(X_AB, "vc_interference: X_AB"), {tolerance, wanted},
                 workspace->scratch.engines, out);
    *metrics = c_api::plain(out.total);
    return 0;
  });
}

}  // extern "C"
