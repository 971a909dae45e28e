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

namespace penumbra::scenes {

/// Primitives that are in the scene several times, and are read once.
class SharedPrimitives {
 public:
  using Number = std::pair<int, std::size_t>;  ///< of a mesh, and of one of its primitives
  struct Primitive {
    std::uint32_t mesh = 0;         ///< index into Instances::meshes
    Object object;                  ///< without what a node says of it
    std::vector<glm::dvec3> local;  ///< of what is measured alone (measures()), all of its vertices
  };

  explicit SharedPrimitives(const tinygltf::Model& model) : model_(model) {}

  /// From now on they are kept, in `to`; before, none is.
  void keep_in(Instances& to, std::span<const PlacedNode> nodes);
  /// Instances are only counted and measured.
  void measure(std::span<const PlacedNode> nodes) {
    measures_ = true;
    keep_in(own_, nodes);
  }

  [[nodiscard]] bool any() const { return to_ != nullptr && !to_->empty(); }
  /// Nothing bends it, it shines nowhere, and it is there again.
  [[nodiscard]] bool may_share(const tinygltf::Primitive& primitive, const tinygltf::Node& node,
                               const Look& look) const;
  /// Nothing for one that has not come, and for a node that bends it.
  [[nodiscard]] const Primitive* find(const Number& number, const tinygltf::Node& node) const;
  const Primitive& add(const Number& number, SharedMesh mesh, Object object, const std::vector<glm::dvec3>& local);
  /// Once more, as the object of that number, after so many triangles of the scene's soup.
  void place(const Primitive& primitive, const PlacedNode& placed, std::size_t object, std::size_t soup_before);

 private:
  const tinygltf::Model& model_;
  Instances* to_ = nullptr;
  Instances own_;
  bool measures_ = false;
  std::vector<std::uint64_t> uses_;  // of each mesh
  std::map<Number, Primitive> all_;
};

}  // namespace penumbra::scenes
