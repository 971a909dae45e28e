// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace penumbra::app {

/// Quantity shown by the picture's colours.
enum class LiveChannel : std::uint8_t { beauty, visibility, error, ids, normals, depth };

/// Mapping of numbers to colours: can change without another picture.
struct LiveDisplay {
  LiveChannel channel = LiveChannel::beauty;
  std::string light;            ///< light whose V is shown
  std::optional<float> stops;   ///< nullopt: chosen from the picture
  std::optional<double> limit;  ///< end of the scale of errors; nullopt: chosen from the picture
};

/// State displayed and changed by the page.
struct LiveState {
  scenes::Scene scene;        ///< without meshes; `lights` as changed, `cameras` as in the file
  scenes::Camera camera;      ///< current camera, as moved
  std::set<std::string> off;  ///< names of lights that are off
  std::string solo;           ///< name of the only light that is on; empty: no restriction
  std::string method;         ///< an entry NAME:key=value:…; empty: the exact area by the best method for each light
  std::optional<std::string> other;     ///< second entry for comparison; nullopt: none
  std::uint32_t light_samples = 0;      ///< 0: exact areas if the method computes them
  std::uint32_t width = 0, height = 0;  ///< 0: the scene's
  bool moving = false;                  ///< a drag is in progress
  bool masks = false;                   ///< masks of pixels were requested
  LiveDisplay display;
};

/// Effect of a message.
enum class LiveChange : std::uint8_t { nothing, display, picture };

LiveState live_state(scenes::Scene scene, const std::string& camera);

/// Changes the state by a message of the page (docs/view.md lists them). Throws InputError or UsageError for invalid
/// messages, and then changes nothing.
LiveChange apply(LiveState& state, const nlohmann::json& message);

nlohmann::ordered_json to_json(const LiveState& state);

/// Returns the names of the lights that are on.
std::vector<std::string> lights_on(const LiveState& state);

/// Returns the state for a new version of the scene's file: values that differ between the two versions are taken from
/// the new one; all others stay as changed by the user. `before`: the file's previous scene, without meshes.
LiveState reloaded(const LiveState& state, const scenes::Scene& before, scenes::Scene now);

/// Returns whether the scenes differ in lights and cameras alone.
bool same_meshes(const scenes::Scene& a, const scenes::Scene& b);
/// Returns a scene that was made by without_meshes(), with the meshes of another.
scenes::Scene with_meshes(scenes::Scene scene, const scenes::Scene& meshes);

}  // namespace penumbra::app
