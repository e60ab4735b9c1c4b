// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "c_api/model_values.h"
#include "c_api/volcontact.h"
#include "volcontact/model/contact_model.h"

namespace volcontact::c_api {

/// What comes before the rows of a state array: their count and the size of one.
inline constexpr int kStateHead = 2;

}  // namespace volcontact::c_api

struct vc_model {
  volcontact::c_api::ModelValues values;
  /// Made of `values`; none while there is no pair.
  std::optional<volcontact::ContactModel> contact;
};
