// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "render/device.hpp"
#include "selftest/check.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "volumes/edges/device/silhouette_pass.hpp"
#include "volumes/raster/wedge_builder.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::selftest {

/// Soup in floats with its edge graph.
struct EdgeMesh {
  explicit EdgeMesh(const mesh::TriangleSoup& soup, double scale = 1);
  [[nodiscard]] mesh::MeshView view() const { return {wide, triangles}; }

  std::vector<glm::vec3> positions;
  std::vector<glm::dvec3> wide;
  std::vector<mesh::Triangle> triangles;
  mesh::EdgeGraph graph;
};

/// Counts of the cases in a silhouette check, so that the caller can verify that the intended cases occurred.
struct SilhouetteTally {
  std::size_t points = 0, silhouettes = 0, ties = 0, open = 0;
};

/// Compares SilhouettePass (which has the mesh), as seen from `l`, with mesh::facings and mesh::signed_multiplicity,
/// both exact: every triangle's side, every silhouette edge with its multiplicity, in order. `counted`: for each
/// triangle, the counted sides.
Check check_silhouettes(volumes::SilhouettePass& pass, const EdgeMesh& mesh, const glm::vec3& l,
                        const std::vector<std::uint32_t>& counted, SilhouetteTally& tally);

struct WedgeTally {
  std::size_t edges = 0, on_host = 0, planes = 0;
};

/// Compares wedges built by the device, for every light: the volumes equal the host's, every plane bounds the penumbra
/// by exact signs, and, with `like_host`, equals the host's to within an angle of 1e-6.
Check check_wedges(const render::Device& device, const visibility::SceneFloats& floats,
                   std::span<const visibility::Light> lights, volumes::Layers layers, bool like_host,
                   WedgeTally& tally);

}  // namespace penumbra::selftest
