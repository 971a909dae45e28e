// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/pictures/frame_render.hpp"
#include "visibility/view_samples.hpp"

#include <penumbra/picture.hpp>

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace penumbra {

struct Picture::State {
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> lights, methods;       ///< for each light
  std::vector<std::size_t> words, light_samples;  ///< for each light; 0: no masks, no light samples
  session::RenderedFrame frame;
  glm::dvec3 origin{0};
  std::vector<glm::vec3> positions, relative_positions, normals;
  std::vector<float> depth;
  std::vector<std::uint32_t> ids;
  std::string stats;
};

}  // namespace penumbra
