// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/model/contact_model.h"

struct vc_workspace {
  volcontact::ContactModel::Workspace scratch;
  volcontact::ContactReport report;
  /// Of the last evaluation, for its tangent; null after an error.
  const volcontact::ContactModel* model = nullptr;
  /// Of vc_evaluate_rates.
  volcontact::ContactReport later;
  std::vector<double> rows, half;
};
