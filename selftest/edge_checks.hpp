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

/// A soup in floats with its edge graph.
struct EdgeMesh {
  explicit EdgeMesh(const mesh::TriangleSoup& soup, double scale = 1);
  [[nodiscard]] mesh::MeshView view() const { return {wide, triangles}; }

  std::vector<glm::vec3> positions;
  std::vector<glm::dvec3> wide;
  std::vector<mesh::Triangle> triangles;
  mesh::EdgeGraph graph;
};

/// What a silhouette check met, so that who calls it can say that it saw what it is about.
struct SilhouetteTally {
  std::size_t points = 0, silhouettes = 0, ties = 0, open = 0;
};

/// SilhouettePass (which has the mesh) from `l`, against mesh::facings and mesh::signed_multiplicity, both exact: every
/// triangle's side, every silhouette edge with its multiplicity, in order. `counted`: of each triangle, the sides that
/// count.
Check check_silhouettes(volumes::SilhouettePass& pass, const EdgeMesh& mesh, const glm::vec3& l,
                        const std::vector<std::uint32_t>& counted, SilhouetteTally& tally);

struct WedgeTally {
  std::size_t edges = 0, on_host = 0, planes = 0;
};

/// Wedges that the device builds, of every light: the volumes are the host's own, every plane bounds the penumbra by
/// exact signs, and, with `like_host`, is the host's to within 1e-6 of an angle.
Check check_wedges(const render::Device& device, const visibility::SceneFloats& floats,
                   std::span<const visibility::Light> lights, volumes::Layers layers, bool like_host,
                   WedgeTally& tally);

}  // namespace penumbra::selftest
