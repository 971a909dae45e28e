#pragma once

#include "import/gltf/gltf_nodes.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/losses.hpp"
#include "scenes/scene.hpp"

#include <cstdint>
#include <optional>
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
/// divided by that again (or by ReadOptions::lumens_per_watt); before version 3.4.36 it wrote watts, of a sun watts a
/// square metre, so that a point or spot lamp's intensity is divided by 4π. It writes cones as angles that fall off as
/// Blender's do. A radius of 0 becomes one so small that shadows are hard.
class PunctualLights {
 public:
  /// `model` and `losses` must outlive it.
  PunctualLights(const tinygltf::Model& model, const ReadOptions& options, Losses& losses)
      : model_(model), options_(options), losses_(losses) {}

  /// The node's lamp, without a name; the node names its lamp in the extension (asserted). Nothing for a lamp of a type
  /// that the extension does not have, which is refused by `name`. Throws InputError for what the extension does not
  /// allow, and for sizes that are none.
  std::optional<AreaLight> light_of(const tinygltf::Node& node, const PlacedNode& placed, const std::string& name);

  /// What was taken for granted, with its count.
  void add_warnings(std::vector<std::string>& warnings) const;

 private:
  /// By what a lamp's intensity is divided; counts what is taken for granted.
  double divisor_of(const std::string& type);

  const tinygltf::Model& model_;
  ReadOptions options_;
  Losses& losses_;
  std::uint64_t without_radius_ = 0, without_angle_ = 0, ranges_ = 0, in_lumens_ = 0, in_watts_ = 0, hard_ = 0;
};

}  // namespace penumbra::scenes
