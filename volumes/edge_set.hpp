#pragma once

#include "mesh/edge_graph.hpp"
#include "render/tree_texels.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// The edges of everything that casts shadow, as device passes take them: each with the planes that its signed
/// multiplicity k_e(p) is made of, in a hierarchy that knows where k_e cannot be anything but 0.
namespace penumbra::volumes {

/// One of an edge's triangles: sgn(n · (p − anchor)) is what it adds to k_e(p). All three edges of a triangle have the
/// same `anchor` and the same n up to its sign, so that p is on one side of it for all three, however the device
/// rounds.
struct EdgeSide {
  glm::vec3 n{0};  ///< not of unit length; 0: no triangle
  glm::vec3 anchor{0};
  std::uint32_t plane = visibility::SceneFloats::kNoPlane;  ///< SceneFloats::plane: the carrier's own adds nothing
};

/// An edge with two of its triangles; an edge of n triangles is ⌈n / 2⌉ records: k_e is their sum.
struct EdgeRecord {
  glm::vec3 a{0}, b{0};
  std::array<EdgeSide, 2> sides;
};

/// The triangles that may shade a light, and their edges.
struct EdgeCasters {
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> triangle;    ///< into the scene's
  std::vector<mesh::Triangle> triangles;  ///< their corners
  mesh::EdgeGraph graph;
};
/// `light_index`: what is this light's own body is left out; −1: nothing is.
EdgeCasters edge_casters(const visibility::SceneFloats& scene, std::int32_t light_index);

/// A half-space on one side of a light's plane, in double. The rectangle tells which triangles reach through the light.
struct LightSide {
  glm::dvec3 center{0}, u{0}, v{0};
  double sign = 1;  ///< +1: where u × v points; −1: behind
};

/// All records with k_e not 0 everywhere. Where triangles reach through the plane of `side`, edges are cut at it, and
/// triangles that may pass through the light itself get a third edge in the plane (docs/signed-crossings.md, cut
/// edges): beside the light, no light sample is between those and any p.
std::vector<EdgeRecord> edge_records(const visibility::SceneFloats& scene, const EdgeCasters& casters,
                                     const std::optional<LightSide>& side);

/// Does anything lie behind that plane, so that records must be cut?
bool reaches_behind(const visibility::SceneFloats& scene, const LightSide& side);

/// As texels: the hierarchy, three a child (render::node_texels' two, and the cone of normals: axis, cosine of its
/// half-angle), and for each leaf slot one in each of six lists: (a, plane 1), (b, plane 2), (n 1), (anchor 1), (n 2),
/// (anchor 2), the numbers of the last four 1 for a record and 0 for an empty slot.
///
/// A cone holds, up to sign, the two normals of each record below such that k_e(p) = 0 where p is in front of both, or
/// behind both. Cosine 0: at least one record below that has none, or normals that point all over.
struct EdgeTexels {
  std::vector<render::Texel> nodes;
  std::array<std::vector<render::Texel>, 6> slots;
  std::uint32_t depth = 0;
  std::uint32_t records = 0;
};
EdgeTexels edge_texels(std::span<const EdgeRecord> records, float scale);

}  // namespace penumbra::volumes
