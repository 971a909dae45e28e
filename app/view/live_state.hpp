#pragma once

#include "scenes/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace penumbra::app {

/// What the picture's colours mean.
enum class LiveChannel : std::uint8_t { beauty, visibility, error, ids, normals, depth };

/// How numbers become colours: what changes without another picture.
struct LiveDisplay {
  LiveChannel channel = LiveChannel::beauty;
  std::string light;            ///< whose V is shown
  std::optional<float> stops;   ///< nothing: chosen from the picture
  std::optional<double> limit;  ///< of errors, the end of the scale; nothing: chosen from the picture
};

/// All that the page shows and changes.
struct LiveState {
  scenes::Scene scene;        ///< without meshes; `lights` as they have been changed, `cameras` as the file has them
  scenes::Camera camera;      ///< that looks, as it has been moved
  std::set<std::string> off;  ///< names of lights that do not shine
  std::string solo;           ///< the only light that does; empty: there is none
  std::string method;         ///< an entry NAME:key=value:…; empty: the exact area by the best for each light
  std::optional<std::string> other;     ///< the entry beside it; nothing: none
  std::uint32_t light_samples = 0;      ///< 0: exact areas where the method has them
  std::uint32_t width = 0, height = 0;  ///< 0: the scene's
  bool moving = false;                  ///< something is being dragged
  bool masks = false;                   ///< the light as each pixel sees it is asked for
  LiveDisplay display;
};

/// What a message changed.
enum class LiveChange : std::uint8_t { nothing, display, picture };

LiveState live_state(scenes::Scene scene, const std::string& camera);

/// Changes the state as a message of the page says (docs/view.md lists them). Throws InputError or UsageError for what
/// cannot be, and then changes nothing.
LiveChange apply(LiveState& state, const nlohmann::json& message);

nlohmann::ordered_json to_json(const LiveState& state);

/// The names of the lights that shine.
std::vector<std::string> lights_on(const LiveState& state);

/// The state on another version of the scene's file: what the file says otherwise than before is the file's, all else
/// as it has been changed by hand. `before`: the file's scene, without meshes.
LiveState reloaded(const LiveState& state, const scenes::Scene& before, scenes::Scene now);

}  // namespace penumbra::app
