#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace penumbra::app {

/// Of a picture's header: the stops that its PNG was exposed by.
inline constexpr const char* kExposureAttribute = "penumbra.exposure";

/// How bright the PNG is: stops by which linear values are multiplied, or found from the picture.
struct Exposure {
  enum class Kind { automatic, first, fixed };
  Kind kind = Kind::automatic;
  float stops = 0;  ///< fixed; first: once it is known
};

/// "auto", "first", a number of stops, or FILE.exr: those that this picture's header says. Throws UsageError;
/// InputError for a picture that does not say.
Exposure parse_exposure(const std::string& text);

/// The stops that an earlier run wrote into a picture's header; nothing if there is no such picture, or it does
/// not say.
std::optional<float> written_exposure(const std::filesystem::path& picture);

}  // namespace penumbra::app
