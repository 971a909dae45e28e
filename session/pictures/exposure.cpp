// SPDX-License-Identifier: Apache-2.0
// Parses --exposure, and reads the stops that an earlier picture's header keeps, so that a resumed sequence
// keeps its brightness.

#include "session/pictures/exposure.hpp"

#include "base/error.hpp"
#include "base/exr.hpp"
#include "session/parse.hpp"

#include <cmath>
#include <string_view>
#include <system_error>

namespace penumbra::session {
namespace {

bool is_picture(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error);
}

}  // namespace

Exposure parse_exposure(const std::string& text) {
  if (text.empty() || text == "auto") return {};
  if (text == "first") return {Exposure::Kind::first, std::nanf("")};
  if (std::filesystem::path(text).extension() == ".exr") {
    const auto written = written_exposure(text);
    if (written) return {Exposure::Kind::fixed, *written};
    throw InputError(
        "--exposure {}: {}", text,
        is_picture(text) ? "its header has no exposure (penumbra.exposure)" : "this picture does not exist");
  }
  const auto stops = parse_number(text.starts_with('+') ? std::string_view(text).substr(1) : std::string_view(text));
  if (!stops || !(std::abs(*stops) <= 100)) {
    throw UsageError(
        "--exposure {}: expected auto, first, stops from -100 to 100 (0: as it is), or a picture's name "
        "(.exr)",
        text);
  }
  return {Exposure::Kind::fixed, static_cast<float>(*stops)};
}

std::optional<float> written_exposure(const std::filesystem::path& picture) {
  if (!is_picture(picture)) return std::nullopt;
  ExrFile file;
  try {
    file = read_exr(picture, {.channels = {"none of them: the header is enough"}});
  } catch (const InputError&) {
    return std::nullopt;
  }
  const auto text = file.attributes.find(kExposureAttribute);
  const auto stops = text == file.attributes.end() ? std::nullopt : parse_number(text->second);
  return stops ? std::optional(static_cast<float>(*stops)) : std::nullopt;
}

}  // namespace penumbra::session
