#pragma once

#include "app/output.hpp"
#include "app/pictures/matte_shares.hpp"
#include "base/atomic_file.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// The names of whole lights' layers: the light's own, with dots and slashes, which make layers in layers, as "_".
/// Where this makes two equal, or one that the picture has for something else, the later one gets "_2", "_3" and so on;
/// each light has its layer's name with "_V" and "_light", too.
std::vector<std::string> layer_names(std::span<const visibility::Light> lights);

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

/// OUT.exr: all channels (README, "What comes out") and header attributes.
void write_picture(const std::filesystem::path& path, const PictureContent& content);
/// Appends it to a file that the caller commits.
void write_picture(AtomicFile& file, const PictureContent& content);

}  // namespace penumbra::app
