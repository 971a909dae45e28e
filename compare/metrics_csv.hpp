#pragma once

#include "compare/stats.hpp"

#include <string>

namespace penumbra::compare {

/// metrics.csv: the numbers of metrics.json that a spreadsheet takes, a row for each method, errors and pairs of
/// the first light, with the names of the JSON as names of columns. What does not apply is an empty field.
std::string metrics_csv(const Metrics& metrics);

}  // namespace penumbra::compare
