// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "volcontact/base/text_reader.h"
#include "volcontact/shape/shapes.h"

namespace volcontact {

/// A solid as one line of words and numbers, without a line end: "box 0.1 0.2 0.3". Read back, it
/// is the same to the bit. docs/c_container.md, "A model as text". Throws std::invalid_argument on
/// a signed distance, which is code.
std::string text_of(const Shape& shape);

/// Reads what text_of writes. Throws std::invalid_argument naming the line, also on solids that
/// are none.
Shape read_shape(TextReader& reader);

/// A pose as 16 numbers, row by row, each with a space before it.
void append_pose(const Pose& pose, std::string& text);
Pose read_pose(TextReader& reader);

}  // namespace volcontact
