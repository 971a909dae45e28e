// SPDX-License-Identifier: Apache-2.0
// Sends a picture's channels to an open tev, under the names that they have in the EXR file.

#include "session/pictures/tev_pictures.hpp"

#include "session/pictures/picture_format.hpp"
#include "visibility/view_samples.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace penumbra::session {

void TevPictures::show(const std::string& name, const PictureContent& content) {
  const std::size_t pixels = content.session.pixel_count();
  std::array<std::vector<float>, 4> colors;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < pixels; ++i) colors[c].push_back(content.sum[i][static_cast<glm::length_t>(c)]);
  }
  colors[3].assign(content.alpha.begin(), content.alpha.end());
  if (content.alpha.empty()) {
    for (const std::int32_t triangle : content.session.samples.triangle)
      colors[3].push_back(triangle == visibility::ViewSamples::kBackground ? 0.0F : 1.0F);
  }
  network::TevPicture picture{name, content.session.width, content.session.height, {}};
  for (std::size_t c = 0; c < colors.size(); ++c) picture.channels.push_back({std::string(1, "RGBA"[c]), colors[c]});
  picture.channels.push_back({"V", content.visibility.front()});
  const std::vector<std::string> layers = layer_names(content.lights.lights);
  for (std::size_t light = 0; light < layers.size() && layers.size() > 1; ++light)
    picture.channels.push_back({layers[light] + ".V", content.visibility[light]});
  client_.show(picture);
}

}  // namespace penumbra::session
