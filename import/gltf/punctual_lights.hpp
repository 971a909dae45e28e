// SPDX-License-Identifier: Apache-2.0
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

namespace penumbra::import {

/// Converts the lamps of KHR_lights_punctual: a directional lamp becomes a sun, a point lamp a sphere, a spot lamp a
/// sphere with a cone. That extension has no sizes: `radius` or `angle` (degrees) come from the extras of the lamp,
/// else from those of its node, else from ReadOptions. `smooth` 1 in the extras means that a cone falls off as
/// Blender's do. Intensities have the extension's units: lux on a surface facing a sun, candela of a sphere seen from
/// afar. The radiance is therefore lux / (π sin²(angle / 2)), or candela / (π radius²). Blender's exporter multiplies
/// watts by 683 lumens, and stores emission in watts: intensities of its files are divided by 683 again (or by
/// ReadOptions::lumens_per_watt). Before version 3.4.36 it wrote watts, for a sun watts per square metre, so that the
/// intensity of a point or spot lamp is divided by 4π. It writes cones as angles that fall off as Blender's do. A
/// radius of 0 becomes one so small that shadows are hard.
class PunctualLights {
 public:
  /// `model` and `losses` must outlive this object.
  PunctualLights(const tinygltf::Model& model, const scenes::ReadOptions& options, scenes::Losses& losses)
      : model_(model), options_(options), losses_(losses) {}

  /// Returns the node's lamp, without a name; the node must have a lamp in the extension (asserted). A lamp of a type
  /// that the extension does not have is added to the losses under `name` as refused, and gives nullopt. Throws
  /// InputError for values that the extension does not allow, and for invalid sizes.
  std::optional<scenes::AreaLight> light_of(const tinygltf::Node& node, const PlacedNode& placed,
                                            const std::string& name);

  /// Adds warnings about assumptions, with their counts.
  void add_warnings(std::vector<std::string>& warnings) const;

 private:
  /// Returns the divisor of a lamp's intensity; counts assumptions.
  double divisor_of(const std::string& type);

  const tinygltf::Model& model_;
  scenes::ReadOptions options_;
  scenes::Losses& losses_;
  std::uint64_t without_radius_ = 0, without_angle_ = 0, ranges_ = 0, in_lumens_ = 0, in_watts_ = 0, hard_ = 0;
};

}  // namespace penumbra::import
