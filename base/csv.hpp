#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace penumbra {

/// A text as a field of a CSV file (RFC 4180): in quotes where a comma, a quote or a line's end needs them.
std::string csv_field(std::string_view text);
/// A number in the shortest digits that read back as the same double; nothing: an empty field.
std::string csv_field(const std::optional<double>& number);

}  // namespace penumbra
