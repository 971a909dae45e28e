#pragma once

namespace tinygltf {
class Model;
}

namespace penumbra::scenes {

/// Did Blender's exporter write the file? It means some things as only Blender does.
bool is_from_blender(const tinygltf::Model& model);

/// Did a version of Blender's exporter write it that puts a lamp's power into `intensity` as Blender has it, watts or,
/// of a sun, watts a square metre? Those before 3.4.36 do; later ones write candela and lux, 683 lumens to a watt.
bool writes_watts(const tinygltf::Model& model);

}  // namespace penumbra::scenes
