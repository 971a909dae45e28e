#pragma once

#include "scenes/studio.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace penumbra::app {

/// The studio around a scene (scenes/studio.hpp), as the user gave it.
struct StudioOptions {
  bool always = false, never = false;
  std::string floor = "auto";
  std::vector<std::string> lights;
};

/// Adds --studio, --no-studio, --floor and --add-light.
void add_studio_options(CLI::App& command, StudioOptions& options);

/// `camera`: the value of --camera, which names a camera of the scene, or says `fit` or EX,EY,EZ:TX,TY,TZ[:FOV]; the
/// camera that is put in then has that text for its name. Throws UsageError that says what would be right.
scenes::StudioWish parse_studio(const StudioOptions& options, const std::string& camera);

}  // namespace penumbra::app
