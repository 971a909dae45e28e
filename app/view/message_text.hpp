#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

/// Messages of the live view and of `serve` as JSON texts.
namespace penumbra::app {

/// Throws InputError for what is no JSON, or nested deeper than any message.
nlohmann::json parse_message(std::string_view text);

/// What is no UTF-8 in it is replaced.
std::string message_text(const nlohmann::ordered_json& message);

/// The message `say`. `level`: note, warning or error.
nlohmann::ordered_json saying(std::string_view level, const std::string& text);

}  // namespace penumbra::app
