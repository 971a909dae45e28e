#pragma once

#include <penumbra/export.hpp>
#include <penumbra/renderer.hpp>
#include <penumbra/scene.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace penumbra {

struct InspectOptions {
  double weld = 0;                 ///< vertices at most this far apart are one
  bool self_intersections = true;  ///< search them, which takes longest
  std::size_t list_limit = 100;    ///< places listed of each defect
};

/// What is wrong with a mesh, and what each method makes of it: the JSON of `penumbra inspect --json`. Throws
/// InputError for a file that cannot be read, or arrays that are no mesh (Scene::add_mesh), and Cancelled. Of `host`
/// the log and progress functions count.
PENUMBRA_API std::string inspect_json(const std::filesystem::path& file, const InspectOptions& options = {},
                                      const RendererOptions& host = {});
PENUMBRA_API std::string inspect_json(std::span<const Vector> positions,
                                      std::span<const std::array<std::uint32_t, 3>> triangles,
                                      const InspectOptions& options = {}, const RendererOptions& host = {});

}  // namespace penumbra
