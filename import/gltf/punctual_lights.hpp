#pragma once

#include "import/gltf/gltf_nodes.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
class Node;
}  // namespace tinygltf

namespace penumbra::scenes {

/// What the lamps of KHR_lights_punctual become: a directional lamp a sun, a point lamp a sphere, a spot lamp a sphere
/// with a cone. They have no size in that extension; `extras` of the lamp, or else of its node, may say `radius` or
/// `angle` (degrees), else ReadOptions does; and `smooth` 1 that a cone falls as Blender's do. Intensities are the
/// extension's: lux of what faces a sun, candela of a sphere seen from afar, so a radiance of lux / π sin²(angle / 2),
/// of candela / π radius². Blender's exporter multiplies watts by 683 lumens, and has emission in watts: there they are
/// divided by that again (or by ReadOptions::lumens_per_watt); and it writes cones as angles whose ways to fall off
/// only it means.
class PunctualLights {
 public:
  PunctualLights(const tinygltf::Model& model, const ReadOptions& options) : model_(model), options_(options) {}

  /// The node's lamp, without a name; the node names its lamp in the extension (asserted).
  /// Throws InputError for what the extension does not allow, and for sizes that are none.
  AreaLight light_of(const tinygltf::Node& node, const PlacedNode& placed);

  /// What was taken for granted, with its count.
  void add_warnings(std::vector<std::string>& warnings) const;

 private:
  const tinygltf::Model& model_;
  ReadOptions options_;
  std::uint64_t without_radius_ = 0, without_angle_ = 0, ranges_ = 0, in_lumens_ = 0;
};

}  // namespace penumbra::scenes
