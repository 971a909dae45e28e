// SPDX-License-Identifier: Apache-2.0
// Uploads a scene's triangle hierarchy to the device.

#include "engines/device/triangle_upload.hpp"

#include <utility>

namespace penumbra::device {
namespace {

using visibility::SceneFloats;
using visibility::Texel;
using visibility::TriangleTree;

std::array<std::vector<Texel>, 3> corner_texels(const SceneFloats& scene, const TriangleTree& tree, float scale,
                                                const TriangleNotes& notes) {
  std::array<std::vector<Texel>, 3> texels;
  for (auto& list : texels) list.reserve(tree.leaves.size() * TriangleTree::kWidth);
  for (const TriangleTree::Leaf& leaf : tree.leaves) {
    for (const std::uint32_t triangle : leaf) {
      std::array<glm::vec3, 3> at{};
      std::array<std::uint32_t, 3> numbers{TriangleTree::kNoTriangle, SceneFloats::kNoPlane, 0xffffffffU};
      if (triangle != TriangleTree::kNoTriangle) {
        at = scene.corners(triangle);
        if (!notes.turns.empty() && notes.turns[triangle] < 0) std::swap(at[1], at[2]);
        numbers = {triangle, scene.plane[triangle] | (notes.tags.empty() ? 0U : notes.tags[triangle]),
                   static_cast<std::uint32_t>(scene.emits[triangle])};
      }
      for (std::size_t i = 0; i < 3; ++i) texels[i].push_back({at[i] * scale, numbers[i]});
    }
  }
  return texels;
}

}  // namespace

void TriangleUpload::prepare(const render::Device& device, const SceneFloats& scene, const TriangleTree& tree,
                             float scale, const TriangleNotes& notes) {
  using render::BufferUse;
  node_texels_ = visibility::node_texels(tree, scale);
  nodes_.emplace(render::make_buffer<Texel>(device, "triangle nodes", node_texels_, BufferUse::texels));
  const std::array<std::vector<Texel>, 3> corners = corner_texels(scene, tree, scale, notes);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners_[i].emplace(render::make_buffer<Texel>(device, "triangle corners", corners[i], BufferUse::texels));
  }
}

}  // namespace penumbra::device
