// SPDX-License-Identifier: Apache-2.0
// Stores a primitive only once if several nodes show it, with an instance for each node. Primitives with a skin or
// morph targets, or that emit light, are not shared: each occurrence is a separate geometry, or a separate light.

#include "import/gltf/gltf_shared.hpp"

#include "import/gltf/gltf_instances.hpp"

#include <tiny_gltf.h>

#include <memory>
#include <utility>

namespace penumbra::import {

void SharedPrimitives::keep_in(scenes::Instances& to, std::span<const PlacedNode> nodes) {
  to_ = &to;
  to = {};
  uses_.assign(model_.meshes.size(), 0);
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(placed.number)];
    if (!placed.visible || node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= uses_.size()) continue;
    const auto instances = instances_of(model_, node, placed.number);
    uses_[static_cast<std::size_t>(node.mesh)] += instances ? instances->size() : 1;
  }
}

bool SharedPrimitives::may_share(const tinygltf::Primitive& primitive, const tinygltf::Node& node,
                                 const Look& look) const {
  return to_ != nullptr && uses_[static_cast<std::size_t>(node.mesh)] > 1 && node.skin < 0 &&
         primitive.targets.empty() && look.radiance == glm::dvec3(0) && !look.emission;
}

const SharedPrimitives::Primitive* SharedPrimitives::find(const Number& number, const tinygltf::Node& node) const {
  const auto found = all_.find(number);
  return node.skin >= 0 || found == all_.end() ? nullptr : &found->second;
}

const SharedPrimitives::Primitive& SharedPrimitives::add(const Number& number, scenes::SharedMesh mesh,
                                                         scenes::Object object, const std::vector<glm::dvec3>& local) {
  Primitive& primitive = all_[number];
  primitive.mesh = static_cast<std::uint32_t>(to_->meshes.size());
  primitive.object = std::move(object);
  if (measures_) primitive.local = local;
  to_->meshes.push_back(std::make_shared<const scenes::SharedMesh>(std::move(mesh)));
  return primitive;
}

void SharedPrimitives::place(const Primitive& primitive, const PlacedNode& placed, std::size_t object,
                             std::size_t soup_before) {
  to_->all.push_back({.mesh = primitive.mesh,
                      .object = static_cast<std::uint32_t>(object),
                      .placement = {placed.to_world},
                      .soup_before = soup_before});
}

}  // namespace penumbra::import
