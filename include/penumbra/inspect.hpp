// SPDX-License-Identifier: Apache-2.0
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
  double weld = 0;                 ///< vertices at most this far apart are merged
  bool self_intersections = true;  ///< search for self-intersections, the slowest search
  std::size_t list_limit = 100;    ///< number of listed locations of each defect
};

/// Returns the defects of a mesh, and each method's verdict on the mesh: the JSON of `penumbra inspect --json`. Throws
/// InputError for a file that cannot be read, or arrays that are not a mesh (Scene::add_mesh), and Cancelled. Uses only
/// the log and progress functions of `host`.
PENUMBRA_API std::string inspect_json(const std::filesystem::path& file, const InspectOptions& options = {},
                                      const RendererOptions& host = {});
PENUMBRA_API std::string inspect_json(std::span<const Vector> positions,
                                      std::span<const std::array<std::uint32_t, 3>> triangles,
                                      const InspectOptions& options = {}, const RendererOptions& host = {});

}  // namespace penumbra
