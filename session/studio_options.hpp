// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/studio.hpp"

#include <string>
#include <vector>

namespace penumbra::session {

/// Studio around a scene (scenes/studio.hpp), as given by the user.
struct StudioOptions {
  bool always = false, never = false;
  std::string floor = "auto";
  std::vector<std::string> lights;
};

/// Parses the options. `camera`: the value of --camera, which names a camera of the scene, or is `fit` or
/// EX,EY,EZ:TX,TY,TZ[:FOV]; an added camera has this text as its name. Throws UsageError, with the expected form, if
/// invalid.
scenes::StudioWish parse_studio(const StudioOptions& options, const std::string& camera);

}  // namespace penumbra::session
