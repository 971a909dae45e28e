// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/sweep/sweep.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace penumbra::app {

nlohmann::ordered_json sweep_json(const Sweep& sweep);
/// Returns one line for each row (RFC 4180), with a column for each swept key that is empty where a method has no such
/// option.
std::string sweep_csv(const Sweep& sweep);
/// Returns a plot of error against time for each size of the lights, each method's rows joined in their order.
std::string sweep_svg(const Sweep& sweep);

}  // namespace penumbra::app
