#pragma once

#include "bench/entry.hpp"

#include <string>
#include <vector>

namespace penumbra::bench {

/// Returns an SVG of error (RMSE to the reference) against seconds of `shadow`, log-log: one panel for each subject,
/// with one curve for each contestant through its numbers of light samples. All panels have the same axes. An error of
/// 0 cannot be shown on such an axis: the picture states the number of omitted points.
std::string svg_picture(const std::vector<Entry>& entries);

}  // namespace penumbra::bench
