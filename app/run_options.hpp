// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/options.hpp"

namespace CLI {
class App;
}

namespace penumbra::app {

/// Adds --lamp-radius, --sun-angle, --lumens-per-watt and --clip.
void add_gltf_options(CLI::App& command, session::GltfOptions& gltf);
/// Adds --studio, --no-studio, --floor and --add-light.
void add_studio_options(CLI::App& command, session::StudioOptions& options);
/// Adds the options of RunOptions with the same meaning in `render` and in `compare`.
void add_run_options(CLI::App& command, session::RunOptions& options);

}  // namespace penumbra::app
