#pragma once

#include "compare/report.hpp"

#include <string>

/// Pictures of the report, of every light. Internal to this room.
namespace penumbra::compare {

std::string gallery_html(const ReportInput& in);
/// Writes V by the method with the largest error next to V by the one with the smallest, with a movable dividing line.
std::string first_look_html(const ReportInput& in);

}  // namespace penumbra::compare
