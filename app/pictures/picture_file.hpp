#pragma once

#include "app/output.hpp"
#include "app/pictures/matte_shares.hpp"
#include "app/pictures/picture_format.hpp"
#include "base/atomic_file.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// Objects and materials, where a pixel has several view samples.
struct Mattes {
  MatteShares objects, materials;
};

/// What goes into OUT.exr. V and beauty of each whole light, each pixel; beauty is empty where none came.
struct PictureContent {
  const Session& session;
  LabelledLights lights;
  std::span<const std::vector<float>> visibility;
  std::span<const std::vector<glm::vec3>> beauty;
  std::span<const glm::vec3> sum;     ///< of all lights' beauty
  std::span<const float> alpha = {};  ///< empty: 1 where the pixel's centre shows a surface, else 0
  std::map<std::string, std::string> more_attributes = {};  ///< by full name
  const Mattes* mattes = nullptr;                           ///< none: those of the pixels' centres
};

/// OUT.exr: its channels (docs/pictures.md) and header attributes. Returns what is to be warned of.
std::vector<std::string> write_picture(const std::filesystem::path& path, const PictureContent& content,
                                       const PictureFormat& format);
/// Appends it to a file that the caller commits.
std::vector<std::string> write_picture(AtomicFile& file, const PictureContent& content, const PictureFormat& format);

/// Throws UsageError for a layer that a picture of the session will not have. `several`: view samples a pixel.
void check_layers(const PictureFormat& format, const Session& session, bool several);

}  // namespace penumbra::app
