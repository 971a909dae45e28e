#pragma once

#include "app/pictures/frame_render.hpp"
#include "app/view/live_state.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::app {

/// The answer of one of the methods that are shown.
struct LiveAnswer {
  std::string method;               ///< with its options: what the page names
  std::uint32_t light_samples = 0;  ///< 0: areas, or a method that has none
  RenderedFrame frame;
  nlohmann::ordered_json seconds;  ///< as in stats.json
  double milliseconds = 0;         ///< of the shadow: phases light and evaluate
};

/// The numbers of what is shown.
struct LivePicture {
  std::uint64_t revision = 0;                     ///< of the state
  bool is_final = false;                          ///< not a quick one to be followed by a better
  std::uint32_t full_width = 0, full_height = 0;  ///< of the final picture
  std::vector<std::string> lights;
  std::vector<LiveAnswer> answers;  ///< one, or two that are compared
  visibility::ViewSamples samples;
  glm::dvec3 origin{0};
  std::size_t triangles = 0;
  float automatic_stops = 0;
  double milliseconds = 0;                 ///< of all of it
  std::map<std::uint64_t, double> stamps;  ///< of each client, of its last change that is in it
};

/// Which light samples each pixel of a final picture sees of a light.
struct LiveMasks {
  std::uint64_t revision = 0;
  std::string light, shape;        ///< name and kind
  std::vector<glm::dvec2> places;  ///< of light samples, in the light's frame, from −1 to 1
  std::vector<std::uint32_t> masks;
  std::size_t words = 0;
};

/// How V of the first answer differs from the second's, over pixels that show a surface.
struct LiveDifference {
  double rmse = 0, bias = 0, largest = 0;
};
/// Nothing unless there are two that know this light.
std::optional<LiveDifference> difference(const LivePicture& picture, const std::string& light);

/// The message that shows a picture: the length of what follows as a 32-bit number, little-endian; a JSON object; then
/// the bytes of each of its `images`, PNG of a final picture, else JPEG. `more`: further members of the object.
std::string frame_message(const LivePicture& picture, const LiveDisplay& display, const nlohmann::ordered_json& more);

/// All answers at one pixel of the final picture's size. `objects`: names of the meshes, by triangle; `masks`
/// may be null, or of another picture.
nlohmann::ordered_json pixel_json(const LivePicture& picture, glm::uvec2 pixel, const scenes::Scene& scene,
                                  const LiveMasks* masks);

}  // namespace penumbra::app
