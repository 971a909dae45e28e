// SPDX-License-Identifier: Apache-2.0
// Adds the radiance of visible domes at background pixels.

#include "session/pictures/sky.hpp"

#include "session/whole_lights.hpp"
#include "visibility/dome_picture.hpp"

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <variant>

namespace penumbra::session {

void add_visible_skies(const Session& session, std::span<std::vector<glm::vec3>> beauty) {
  const std::vector<WholeLight> wholes = whole_lights(session.lights);
  for (std::size_t i = 0; i < wholes.size(); ++i) {
    const visibility::Light& light = session.lights[wholes[i].first];
    const scenes::AreaLight& source = session.scene.lights[static_cast<std::size_t>(light.index)];
    const auto* const dome = std::get_if<scenes::Dome>(&source.shape);
    if (dome == nullptr || !source.visible || beauty[i].empty()) continue;
    const visibility::DomeFrame frame = visibility::dome_frame(dome->up, dome->rotate);
    const auto seen_along = [&](const glm::dvec3& direction) {
      const visibility::SkyPlace place = frame.place(direction);
      if (dome->half && !(place.height > 0)) return glm::dvec3(0);
      if (!source.texture) return source.radiance;
      return source.radiance * glm::dvec3(source.texture->texels[visibility::sky_texel(*source.texture, place)]);
    };
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, session.height), [&](const auto& rows) {
      for (std::uint32_t y = rows.begin(); y != rows.end(); ++y) {
        for (std::uint32_t x = 0; x < session.width; ++x) {
          const std::size_t pixel = std::size_t{y} * session.width + x;
          if (session.samples.triangle[pixel] == visibility::ViewSamples::kBackground)
            beauty[i][pixel] += glm::vec3(seen_along(session.camera.ray(x, y).direction));
        }
      }
    });
  }
}

}  // namespace penumbra::session
