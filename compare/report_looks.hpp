#pragma once

#include "compare/report.hpp"

#include <cstddef>
#include <string>

/// Tables of the location and the perception of errors. Internal to this room.
namespace penumbra::compare {

/// Returns RMSE by class of pixel, by width of the penumbra and by distance of the hiding object. `under`: " under
/// light …", or empty.
std::string classes_html(const ReportInput& in, std::size_t light, const std::string& under);
/// Returns perceived errors, banding, FLIP; and the error of scalar methods due to V · ∫G in place of ∫G V. Empty if
/// none is known.
std::string looks_html(const ReportInput& in);

}  // namespace penumbra::compare
