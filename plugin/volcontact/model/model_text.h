// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "volcontact/model/contact_model.h"

namespace volcontact {

/// A contact model as lines of text: its choices, its numbers, then its pairs, as the C container
/// reads them (vc_model_create_text). docs/c_container.md, "A model as text". Throws
/// std::invalid_argument on a signed distance and on a law that is not of the library.
std::string text_of(const ContactModel& model);

}  // namespace volcontact
