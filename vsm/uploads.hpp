#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/triangle_tree.hpp"
#include "visibility/view_samples.hpp"
#include "vsm/light_frame.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra::vsm {

/// One texel of the shaders' buffers: three floats and a number, read as bits so that nothing is flushed to zero.
struct Texel {
  glm::vec3 value{0};
  std::uint32_t number = 0;
};
static_assert(sizeof(Texel) == 16);

/// Two texels a child, eight children a node: (middle, reference), (half extent, 0). Boxes are rounded outward.
std::vector<Texel> node_texels(const visibility::TriangleTree& tree, float scale);

/// For each slot of each leaf: (a, triangle), (b, plane), (c, light that the triangle is the body of).
std::array<std::vector<Texel>, 3> corner_texels(const visibility::TriangleTree& tree,
                                                const visibility::SceneFloats& scene, float scale);

/// Two texels a pixel: (p, carrying triangle), (normal, plane).
std::vector<Texel> view_texels(const visibility::ViewSamples& samples, const visibility::SceneFloats& scene,
                               float scale);

/// The shaders' table of light samples: uint first_point[257], then (s, t) of each, sorted by t, so that a triangle
/// looks at one stretch of them. Rows are computed, not read: their table is empty and their order the contract's.
struct SampleTable {
  std::vector<std::byte> bytes;
  std::vector<std::uint32_t> bit_of;  ///< for each of the shaders' sample numbers, the light sample
};
SampleTable make_sample_table(const LightFrame& frame, bool rows);

}  // namespace penumbra::vsm
