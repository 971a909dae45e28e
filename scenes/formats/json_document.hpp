// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

/// JSON with places for messages, the basis of the scene's JSON reader. Internal to scenes/.
namespace penumbra::scenes {

/// A place in a JSON file, for messages: the file as the user named it and a JSON pointer (RFC 6901).
struct Place {
  std::string file, pointer;

  [[nodiscard]] Place operator/(std::string_view key) const;
  [[nodiscard]] Place operator/(std::size_t index) const;
  /// Returns "scene.json: /meshes/0", or "scene.json" for the whole document.
  [[nodiscard]] std::string str() const;
};

/// Runs `make`; prefixes the message of an Error from `make` with the place in the scene file.
template <typename Make>
auto at_place(const Place& place, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}: {}", place.str(), error.what()));
  }
}

/// Parses JSON strictly. Throws InputError with line and column for a syntax error, and with the JSON pointer for
/// errors that libraries accept silently: a number beyond double's range, a duplicate key, excessive nesting.
nlohmann::json parse_json(std::string_view text, const std::string& file);

/// Returns the whole text file; throws InputError if the file is missing, a folder, a device, or unreadable.
std::string read_text_file(const std::filesystem::path& file);

/// Describes a value in words: `a string "x"`, `the number 5`, `an array of 2 values`.
std::string describe_value(const nlohmann::json& value);

}  // namespace penumbra::scenes
