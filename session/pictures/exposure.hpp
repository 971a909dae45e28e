// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace penumbra::session {

/// Attribute of a picture's header: the stops of its PNG's exposure.
inline constexpr const char* kExposureAttribute = "penumbra.exposure";

/// Brightness of the PNG: a number of stops, or automatic from the picture.
struct Exposure {
  enum class Kind { automatic, first, fixed };
  Kind kind = Kind::automatic;
  float stops = 0;  ///< with fixed; with first: set once known
};

/// Parses "auto", "first", a number of stops, or FILE.exr: the stops in this picture's header. Throws UsageError;
/// throws InputError for a picture without them.
Exposure parse_exposure(const std::string& text);

/// Returns the stops in the header of a picture written by an earlier run; nullopt if there is no such picture, or no
/// such attribute.
std::optional<float> written_exposure(const std::filesystem::path& picture);

}  // namespace penumbra::session
