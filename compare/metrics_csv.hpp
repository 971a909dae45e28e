// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/stats.hpp"

#include <string>

namespace penumbra::compare {

/// Returns metrics.csv: the scalar numbers of metrics.json, one row for each method, errors and pairs of the first
/// light, with the names of the JSON as names of columns. Values that do not apply are empty fields.
std::string metrics_csv(const Metrics& metrics);

}  // namespace penumbra::compare
