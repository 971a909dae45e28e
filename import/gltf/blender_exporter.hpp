// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tinygltf {
class Model;
}

namespace penumbra::import {

/// Returns whether Blender's exporter wrote the file, which uses some features in its own sense.
bool is_from_blender(const tinygltf::Model& model);

/// Returns whether a version of Blender's exporter wrote the file that stores a lamp's power in `intensity` in
/// Blender's unit, watts or, for a sun, watts a square metre. Versions before 3.4.36 do; later ones write candela and
/// lux, 683 lumens to a watt.
bool writes_watts(const tinygltf::Model& model);

}  // namespace penumbra::import
