// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// A glTF model under construction, with one scene and one buffer. Internal to this room: uses TinyGLTF's types.
namespace penumbra::scenes {

/// Every returned index is valid in the model; buffer views are multiples of four bytes.
class GlbModel {
 public:
  GlbModel();

  int add_material(tinygltf::Material material);
  int add_camera(tinygltf::Camera camera);
  /// Adds an accessor with its bounds, as POSITION requires. Throws InputError if the buffer would exceed a GLB's 4
  /// GiB.
  int add_positions(const std::vector<glm::vec3>& positions);
  /// Adds an accessor of any other vertex attribute.
  int add_attribute(const std::vector<glm::vec2>& values);
  int add_attribute(const std::vector<glm::vec3>& values);
  int add_attribute(const std::vector<glm::vec4>& values);
  /// Adds an embedded image from a PNG's bytes.
  int add_png(const std::string& name, std::span<const std::byte> bytes);
  int add_texture(int image, tinygltf::Sampler sampler);
  /// Returns a primitive. `mode`: TINYGLTF_MODE_…; `indices` are into the accessor `positions`.
  tinygltf::Primitive primitive(int mode, int positions, const std::vector<std::uint32_t>& indices, int material);
  int add_mesh(tinygltf::Mesh mesh);
  /// Adds the mesh, and a node of the same name that shows it.
  int add_mesh_node(tinygltf::Mesh mesh);
  int add_node(tinygltf::Node node);
  /// Adds a lamp of KHR_lights_punctual.
  int add_lamp(tinygltf::Light lamp);
  void add_root(int node);
  void uses_extension(const std::string& name) { model_.extensionsUsed.push_back(name); }

  /// Returns the file's bytes.
  [[nodiscard]] std::string encoded();

 private:
  int add_view(const void* data, std::size_t length, int target);
  int add_accessor(const void* data, std::size_t count, std::size_t stride, int component_type, int type, int target);
  template <typename Vector>
  int add_vectors(const std::vector<Vector>& values, int type);

  tinygltf::Model model_;
};

}  // namespace penumbra::scenes
