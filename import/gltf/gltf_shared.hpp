// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/gltf_nodes.hpp"
#include "import/gltf/gltf_surface.hpp"
#include "scenes/instances.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace tinygltf {
class Model;
class Node;
struct Primitive;
}  // namespace tinygltf

namespace penumbra::import {

/// Primitives that are in the scene several times, and are read once.
class SharedPrimitives {
 public:
  using Number = std::pair<int, std::size_t>;  ///< of a mesh, and of one of its primitives
  struct Primitive {
    std::uint32_t mesh = 0;         ///< index into Instances::meshes
    scenes::Object object;          ///< without the properties that a node sets
    std::vector<glm::dvec3> local;  ///< if only measuring (measures()): all of its vertices
  };

  explicit SharedPrimitives(const tinygltf::Model& model) : model_(model) {}

  /// Stores primitives in `to` from now on; before this call none is stored.
  void keep_in(scenes::Instances& to, std::span<const PlacedNode> nodes);
  /// Counts and measures instances without storing them.
  void measure(std::span<const PlacedNode> nodes) {
    measures_ = true;
    keep_in(own_, nodes);
  }

  [[nodiscard]] bool any() const { return to_ != nullptr && !to_->empty(); }
  /// Returns whether the primitive can be shared: not deformed, not emissive, and used again.
  [[nodiscard]] bool may_share(const tinygltf::Primitive& primitive, const tinygltf::Node& node,
                               const Look& look) const;
  /// Returns null for a primitive that was not added yet, and for a node that deforms it.
  [[nodiscard]] const Primitive* find(const Number& number, const tinygltf::Node& node) const;
  const Primitive& add(const Number& number, scenes::SharedMesh mesh, scenes::Object object,
                       const std::vector<glm::dvec3>& local);
  /// Adds an instance as the object of that number; `soup_before` triangles of the scene's soup come before it.
  void place(const Primitive& primitive, const PlacedNode& placed, std::size_t object, std::size_t soup_before);

 private:
  const tinygltf::Model& model_;
  scenes::Instances* to_ = nullptr;
  scenes::Instances own_;
  bool measures_ = false;
  std::vector<std::uint64_t> uses_;  // for each mesh
  std::map<Number, Primitive> all_;
};

}  // namespace penumbra::import
