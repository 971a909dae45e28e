#pragma once

#include "compare/report.hpp"

#include <string>

namespace penumbra::compare {

/// Why each method is wrong, light by light: what repairing each cause of error alone changes, a bar each, what is left
/// when all are repaired, how that was found out, and pictures of where each repair acts. Empty if no method has a
/// budget. Internal to this room.
std::string error_budget_html(const ReportInput& in);

}  // namespace penumbra::compare
