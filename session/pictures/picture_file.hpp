// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/atomic_file.hpp"
#include "session/output.hpp"
#include "session/pictures/matte_shares.hpp"
#include "session/pictures/picture_format.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Mattes of objects and materials, with several view samples a pixel.
struct Mattes {
  MatteShares objects, materials;
};

/// Content of OUT.exr. V and beauty of each whole light, each pixel; beauty is empty for lights without results.
struct PictureContent {
  const Session& session;
  LabelledLights lights;
  std::span<const std::vector<float>> visibility;
  std::span<const std::vector<glm::vec3>> beauty;
  std::span<const glm::vec3> sum;     ///< sum of all lights' beauty
  std::span<const float> alpha = {};  ///< empty: 1 where the pixel's centre shows a surface, else 0
  std::map<std::string, std::string> more_attributes = {};  ///< by full name
  const Mattes* mattes = nullptr;                           ///< nullptr: mattes of the pixels' centres
};

/// Writes OUT.exr: its channels (docs/pictures.md) and header attributes. Returns warnings.
std::vector<std::string> write_picture(const std::filesystem::path& path, const PictureContent& content,
                                       const PictureFormat& format);
/// Writes OUT.exr to a file that the caller commits. Returns warnings.
std::vector<std::string> write_picture(AtomicFile& file, const PictureContent& content, const PictureFormat& format);

/// Throws UsageError for a layer that a picture of the session will not have. `several`: several view samples a pixel.
void check_layers(const PictureFormat& format, const Session& session, bool several);

}  // namespace penumbra::session
