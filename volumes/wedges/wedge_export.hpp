// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/wedge_validation.hpp"

#include <filesystem>
#include <span>

namespace penumbra::volumes {

struct WedgesToExport {
  std::span<const Wedge> wedges;
  const LightHull& light;
  Box box;               ///< the box that wedges are cut by
  glm::dvec3 origin{0};  ///< origin of the scene floats: files are in world space
  std::span<const Violation> violations;
};

/// Writes the wedges for viewing, in the format of the file's extension (.glb, .obj or .ply): the light's hull; each
/// wedge as a closed mesh (blue, with violations red) with its edge as a line; a small octahedron at each offending
/// point. In GLB and OBJ everything has a name ("wedge 12", "edge 12", "violation 0 of wedge 12"); of more than 1000
/// wedges, several share one name ("wedges 0 to 9"). PLY has colours only. `everywhere`, `split` and `empty` wedges are
/// written as edges alone. Throws ResourceError if the file cannot be written; the file appears whole or not at all.
void export_wedges(const std::filesystem::path& file, const WedgesToExport& what);

}  // namespace penumbra::volumes
