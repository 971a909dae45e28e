#pragma once

#include "compare/report.hpp"

#include <string>

namespace penumbra::compare {

/// Returns the causes of each method's error, light by light: the change by repairing each cause alone, one bar each,
/// the remaining error when all are repaired, the runs behind these numbers, and pictures of the pixels where each
/// repair acts. Empty if no method has a budget. Internal to this room.
std::string error_budget_html(const ReportInput& in);

}  // namespace penumbra::compare
