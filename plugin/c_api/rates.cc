// SPDX-License-Identifier: Apache-2.0
// States of the laws as a solver integrates them: their time derivatives.
#include <algorithm>
#include <cstring>

#include "c_api/guarded.h"
#include "c_api/model.h"
#include "c_api/workspace.h"
#include "volcontact/base/check.h"

using namespace volcontact;
using namespace volcontact::c_api;

namespace {

Pose advanced(const Pose& pose, const Twist& twist, double time) {
  const double angle = twist.angular.norm() * time;
  Pose out = pose;
  out.translation += time * twist.linear;
  if (angle > 0.0) {
    out.rotation = rotation_about(twist.angular.normalized(), angle) * pose.rotation;
  }
  return out;
}

// The rows as if their sites had been seen where the bodies are now: no way, no turn since then.
void bring_to_now(const BodyMotion& motion, int row, std::vector<double>& rows) {
  VolumeMetrics any;
  any.volume = 1.0;
  const SiteHead now = site_head(0, any, motion);
  const Mat3 R_AB = Mat3::from(now.rotation_AB);
  const Vec3 p_AB = Vec3::from(now.origin_B_A);
  for (std::size_t at = kStateHead; at + static_cast<std::size_t>(row) <= rows.size();
       at += static_cast<std::size_t>(row)) {
    SiteHead head;
    std::memcpy(static_cast<void*>(&head), &rows[at], sizeof head);
    const Vec3 point_A = Vec3::from(head.point_A);
    const Vec3 point_B =
        Mat3::from(head.rotation_AB).transpose() * (point_A - Vec3::from(head.origin_B_A));
    const Vec3 point = 0.5 * (point_A + R_AB * point_B + p_AB);  // half with A, half with B
    point.to(head.point_A);
    std::copy_n(now.rotation_AB, 9, head.rotation_AB);
    std::copy_n(now.origin_B_A, 3, head.origin_B_A);
    std::memcpy(&rows[at], &head, sizeof head);
  }
}

// Rows of `report` a time later, with the motion kept up.
void look_ahead(const ContactModel& contact, const BodyMotion& now, const double* rows, int count,
                double time, vc_workspace& workspace) {
  const BodyMotion then{advanced(now.X_WA, now.V_WA, time), advanced(now.X_WB, now.V_WB, time),
                        now.V_WA, now.V_WB};
  const SiteMemory memory{rows, count, contact.row_size(), time};
  contact.evaluate(then, memory, workspace.scratch, workspace.later);
}

}  // namespace

extern "C" int vc_evaluate_rates(const vc_model* model, vc_workspace* workspace,
                                 const vc_motion* motion, const double* state, double* next_state,
                                 double* rates, int state_size, vc_result* result) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require_given(workspace, function, "workspace");
    require_given(motion, function, "motion");
    check(model->contact.has_value(), [] {
      return "vc_evaluate_rates: the model has no pairs; add one with vc_model_add_pair";
    });
    const ContactModel& contact = *model->contact;
    const int row = contact.row_size();
    if (row == 0) {
      return vc_evaluate(model, workspace, motion, nullptr, nullptr, 0, 0.0, result);
    }
    require_given(next_state, function, "next_state");
    require_given(rates, function, "rates");
    check(state_size >= kStateHead, [] {
      return "vc_evaluate_rates: state_size is too small; vc_model_state_size tells the size";
    });
    const BodyMotion bodies{pose_from(motion->X_WA, "vc_evaluate_rates: X_WA"),
                            pose_from(motion->X_WB, "vc_evaluate_rates: X_WB"),
                            twist_from(motion->V_WA, "vc_evaluate_rates: V_WA"),
                            twist_from(motion->V_WB, "vc_evaluate_rates: V_WB")};
    std::vector<double>& rows = workspace->rows;
    rows.assign(static_cast<std::size_t>(state_size), 0.0);
    if (state) {
      std::copy_n(state, state_size, rows.begin());
      bring_to_now(bodies, row, rows);
    }
    const int code =
        vc_evaluate(model, workspace, motion, rows.data(), next_state, state_size, 0.0, result);
    if (code != 0) return code;
    std::fill(rates, rates + state_size, 0.0);
    const int count = static_cast<int>(next_state[0]);
    if (count == 0 || result->forgotten > 0) return 0;
    // Two differences ahead make one of second order; the law is exact for a motion kept up.
    constexpr double kTime = 2e-6;  // [s]
    const double* now = next_state + kStateHead;
    look_ahead(contact, bodies, now, count, 0.5 * kTime, *workspace);
    workspace->half = workspace->later.memory;
    const ByChannel stored_half = workspace->later.bristle_energy;
    look_ahead(contact, bodies, now, count, kTime, *workspace);
    const std::vector<double>&half = workspace->half, &whole = workspace->later.memory;
    const auto size = static_cast<std::size_t>(count) * static_cast<std::size_t>(row);
    if (half.size() != size || whole.size() != size) return 0;  // a site ends this moment
    // What a bound that shrinks takes from the bristles is dissipated too, so power is what was
    // taken from the motion less what is stored of it.
    const ContactReport& report = workspace->report;
    const ByChannel &stored = report.bristle_energy,
                    &stored_whole = workspace->later.bristle_energy;
    result->power[2] = report.taken.slide -
                       (4.0 * stored_half.slide - 3.0 * stored.slide - stored_whole.slide) / kTime;
    result->power[3] = report.taken.spin -
                       (4.0 * stored_half.spin - 3.0 * stored.spin - stored_whole.spin) / kTime;
    for (std::size_t at = 0; at < size; at += static_cast<std::size_t>(row)) {
      for (std::size_t i = at + kSiteHead; i < at + static_cast<std::size_t>(row); ++i) {
        rates[kStateHead + i] = (4.0 * half[i] - 3.0 * now[i] - whole[i]) / kTime;
      }
    }
    return 0;
  });
}
