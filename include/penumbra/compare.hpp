// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/export.hpp>
#include <penumbra/renderer.hpp>
#include <penumbra/scene.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

struct CompareOptions {
  /// Entries NAME:key=value:key=value, or the groups geometry, image, all, default.
  std::vector<std::string> methods = {"default"};
  /// Name of the reference: raytrace, exact, or an entry with exact areas (NAME:key=value).
  std::string reference = "raytrace";
  std::string reference_samples = "1024";  ///< light samples of the reference, or same
  std::uint32_t width = 0, height = 0;     ///< in pixels; 0: the scene's size
  std::uint32_t light_samples = 256;       ///< for methods that use light samples
  std::string sample_pattern = {};         ///< rows (default), grid, sobol, jittered or rgss
  std::vector<std::string> lights = {};    ///< only these lights; empty: all
  std::string camera = {};
  std::uint32_t runs = 0;          ///< timed runs of each entry; 0: as many as fit into two seconds, at most five
  bool error_budget = false;       ///< compute the causes of error of each method
  std::filesystem::path out = {};  ///< folder for pictures and the report; empty: none are written
};

/// Compares several methods with a reference on the same view samples and returns the text of metrics.json. Throws as
/// Renderer::render().
PENUMBRA_API std::string compare_json(const Scene& scene, const CompareOptions& options = {},
                                      const RendererOptions& renderer = {});

}  // namespace penumbra
