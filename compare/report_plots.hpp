#pragma once

#include "compare/report.hpp"

#include <string>

/// The report's drawings of numbers, as SVG: they need no script. Internal to this room.
namespace penumbra::compare {

/// RMSE of V over all lights against seconds for the shadow, a point a method, both axes logarithmic; what has no error
/// at all stands on a line of its own. Empty if no method has both.
std::string error_against_time_html(const ReportInput& in);

}  // namespace penumbra::compare
