#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// "; did you mean X?" for the name that is nearest to `text` by Levenshtein's distance, if at most a third of its
/// letters differ, else nothing. Of several as near the first.
std::string did_you_mean(std::string_view text, const std::vector<std::string>& names);

}  // namespace penumbra
