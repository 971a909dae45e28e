// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

/// Messages of the live view and of `serve` as JSON texts.
namespace penumbra::app {

/// Parses a message. Throws InputError if `text` is not JSON, or nested deeper than any valid message.
nlohmann::json parse_message(std::string_view text);

/// Returns the message as text; bytes that are not UTF-8 are replaced.
std::string message_text(const nlohmann::ordered_json& message);

/// Returns the start of a binary message: the length of the header as a 32-bit number, little-endian; the header, JSON,
/// followed by blanks so that the message's length is a multiple of four.
std::string message_start(const nlohmann::ordered_json& header);

/// Returns the message `say`. `level`: note, warning or error.
nlohmann::ordered_json saying(std::string_view level, const std::string& text);

}  // namespace penumbra::app
