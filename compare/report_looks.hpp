#pragma once

#include "compare/report.hpp"

#include <cstddef>
#include <string>

/// Tables of where errors are and how they look. Internal to this room.
namespace penumbra::compare {

/// RMSE by class of pixel, by how wide the penumbra is and how far what hides the light. `under`: " under light …", or
/// nothing.
std::string classes_html(const ReportInput& in, std::size_t light, const std::string& under);
/// Shown errors, banding, FLIP; and what V · ∫G in place of ∫G V costs scalar methods. Empty if nothing is known.
std::string looks_html(const ReportInput& in);

}  // namespace penumbra::compare
