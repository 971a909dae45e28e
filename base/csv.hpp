// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace penumbra {

/// Returns `text` as a field of a CSV file (RFC 4180): quoted where it contains a comma, a quote or an end of line.
std::string csv_field(std::string_view text);
/// Returns a number in the shortest digits that read back as the same double, and an empty field for nullopt.
std::string csv_field(const std::optional<double>& number);

}  // namespace penumbra
