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
  /// Or exact, or an entry whose areas are exact (NAME:key=value).
  std::string reference = "raytrace";
  std::string reference_samples = "1024";  ///< light samples of the reference, or same
  std::uint32_t width = 0, height = 0;     ///< pixels; 0: the scene's
  std::uint32_t light_samples = 256;       ///< of methods that have them
  std::string sample_pattern = {};         ///< rows (default), grid, sobol, jittered or rgss
  std::vector<std::string> lights = {};    ///< these alone; empty: all
  std::string camera = {};
  std::uint32_t runs = 0;          ///< timed runs of each entry; 0: as many as two seconds hold, at most five
  bool error_budget = false;       ///< why each image-based method is wrong
  std::filesystem::path out = {};  ///< a folder for pictures and the report; empty: none are written
};

/// Several methods on the same view samples against a reference: the text of metrics.json. Throws as
/// Renderer::render().
PENUMBRA_API std::string compare_json(const Scene& scene, const CompareOptions& options = {},
                                      const RendererOptions& renderer = {});

}  // namespace penumbra
