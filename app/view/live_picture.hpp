// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/view/live_state.hpp"
#include "app/view/whole_scene.hpp"
#include "session/pictures/frame_render.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec2.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::app {

/// Result of one of the displayed methods.
struct LiveAnswer {
  std::string method;               ///< with its options, in the page's form
  std::uint32_t light_samples = 0;  ///< 0: exact areas, or a method without light samples
  session::RenderedFrame frame;
  nlohmann::ordered_json seconds;  ///< as in stats.json
  double milliseconds = 0;         ///< of the shadow: phases light and evaluate
};

/// Numbers of the displayed picture.
struct LivePicture {
  std::uint64_t revision = 0;                     ///< of the state
  bool is_final = false;                          ///< not a quick picture to be followed by a better one
  std::uint32_t full_width = 0, full_height = 0;  ///< of the final picture
  std::vector<std::string> lights;
  std::vector<LiveAnswer> answers;  ///< one, or two that are compared
  visibility::ViewSamples samples;
  glm::dvec3 origin{0};
  std::size_t triangles = 0;
  float automatic_stops = 0;
  double milliseconds = 0;                 ///< of the whole picture
  std::map<std::uint64_t, double> stamps;  ///< for each client, the stamp of its last change included in the picture
};

/// Light samples of a light visible at each pixel of a final picture.
struct LiveMasks {
  std::uint64_t revision = 0;
  std::string light, shape;        ///< name and kind
  std::vector<glm::dvec2> places;  ///< of light samples, in the light's frame, from −1 to 1
  std::vector<std::uint32_t> masks;
  std::size_t words = 0;
};

/// Difference between V of the first and the second answer, over pixels that show a surface.
struct LiveDifference {
  double rmse = 0, bias = 0, largest = 0;
};
/// Returns nullopt unless there are two answers for this light.
std::optional<LiveDifference> difference(const LivePicture& picture, const std::string& light);

/// Returns the message of a picture: the length of the remainder as a 32-bit number, little-endian; a JSON object; then
/// the bytes of each of its `images`, PNG for a final picture, else JPEG. `more`: further members of the object.
std::string frame_message(const LivePicture& picture, const LiveDisplay& display, const nlohmann::ordered_json& more);

/// Returns all answers at one pixel of the final picture's size. `whole`: provides the names of the meshes; `masks` may
/// be null, or belong to another picture.
nlohmann::ordered_json pixel_json(const LivePicture& picture, glm::uvec2 pixel, const WholeScene& whole,
                                  const LiveMasks* masks);

}  // namespace penumbra::app
