#pragma once

#include "compare/report.hpp"

#include <string>

/// Plots of the report, as SVG: without script. Internal to this room.
namespace penumbra::compare {

/// Returns a plot of RMSE of V over all lights against seconds for the shadow, one point for each method, both axes
/// logarithmic; methods without any error are on a line of their own. Empty if no method has both numbers.
std::string error_against_time_html(const ReportInput& in);

}  // namespace penumbra::compare
