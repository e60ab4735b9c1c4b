// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace volcontact {

/// The candidate closest to `word` by edit distance (insert, delete, replace, swap of neighbours);
/// empty when none is near enough to be a plausible misspelling.
std::string nearest_spelling(std::string_view word, const std::vector<std::string>& candidates);

/// " (did you mean 'x'?)" or "" when nothing is near: ready to be appended to a message.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace volcontact
