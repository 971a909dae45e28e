#pragma once

#include "bench/entry.hpp"

#include <string>
#include <vector>

namespace penumbra::bench {

/// Error (RMSE to the reference) against seconds of `shadow`, log-log, as SVG: one panel for each subject, and in it
/// one curve for each contestant through its numbers of light samples. All panels have the same axes. An error of 0 has
/// no place on such an axis: the picture says how many points it leaves out.
std::string svg_picture(const std::vector<Entry>& entries);

}  // namespace penumbra::bench
