// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tinygltf {
class Model;
}

namespace penumbra::import {

/// Returns whether the file was written by Blender's exporter, which gives some features a meaning of its own.
bool is_from_blender(const tinygltf::Model& model);

/// Returns whether the file was written by a version of Blender's exporter that stores a lamp's power in `intensity` in
/// Blender's unit: watts, or for a sun watts per square metre. Versions before 3.4.36 do; later ones write candela and
/// lux, with 683 lumens per watt.
bool writes_watts(const tinygltf::Model& model);

}  // namespace penumbra::import
