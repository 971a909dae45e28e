// SPDX-License-Identifier: Apache-2.0
// Messages of `view` as bytes: JSON whose depth is bounded before it is parsed, and binary messages that begin with the
// length of their JSON, padded to four bytes so that numbers after it can be read in place.

#include "app/view/message_text.hpp"

#include "base/error.hpp"

#include <nlohmann/json.hpp>

#include <bit>
#include <cstdint>
#include <cstring>

namespace penumbra::app {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

/// Returns whether the JSON is nested deeper than any valid message: copying and writing JSON is recursive.
bool is_deep(std::string_view text) {
  constexpr int kMost = 32;
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMost) return true;
  }
  return false;
}

}  // namespace

json parse_message(std::string_view text) {
  if (is_deep(text)) throw InputError("a message is nested too deeply");
  json message = json::parse(text, nullptr, false);
  if (message.is_discarded()) throw InputError("a message must be JSON");
  return message;
}

std::string message_text(const ordered_json& message) {
  return message.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string message_start(const ordered_json& header) {
  std::string text = message_text(header);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto length = static_cast<std::uint32_t>(text.size());
  static_assert(std::endian::native == std::endian::little);
  std::string message(sizeof(length), '\0');
  std::memcpy(message.data(), &length, sizeof(length));
  return message + text;
}

ordered_json saying(std::string_view level, const std::string& text) {
  return {{"type", "say"}, {"level", level}, {"text", text}};
}

}  // namespace penumbra::app
