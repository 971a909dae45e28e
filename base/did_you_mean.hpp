// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// Returns "; did you mean X?" for the name that is nearest to `text` by Levenshtein distance, if at most a third of
/// its letters differ, else an empty text. Among equally near names the first wins.
std::string did_you_mean(std::string_view text, const std::vector<std::string>& names);

}  // namespace penumbra
