#pragma once

#include "compare/report.hpp"

#include <string>

/// Pictures of the report, of every light. Internal to this room.
namespace penumbra::compare {

std::string gallery_html(const ReportInput& in);
/// V by the method with the largest error beside V by the one with the smallest, with a line between them to move.
std::string first_look_html(const ReportInput& in);

}  // namespace penumbra::compare
