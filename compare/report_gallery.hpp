#pragma once

#include "compare/report.hpp"

#include <string>

/// Pictures of the report, of every light. Internal to this room.
namespace penumbra::compare {

std::string gallery_html(const ReportInput& in);

}  // namespace penumbra::compare
