// SPDX-License-Identifier: Apache-2.0
// Builds a GLB in memory, one buffer and one accessor after the other. Positions get the bounds that glTF 2.0 demands.

#include "scenes/formats/glb_model.hpp"

#include "base/error.hpp"

#include <glm/common.hpp>

#include <cstring>
#include <limits>
#include <sstream>
#include <utility>

namespace penumbra::scenes {
namespace {

template <typename Element>
int push(std::vector<Element>& elements, Element element) {
  elements.push_back(std::move(element));
  return static_cast<int>(elements.size()) - 1;
}

}  // namespace

GlbModel::GlbModel() {
  model_.asset.version = "2.0";
  model_.asset.generator = "penumbra";
  model_.scenes.emplace_back();
  model_.defaultScene = 0;
  model_.buffers.emplace_back();
}

int GlbModel::add_material(tinygltf::Material material) {
  return push(model_.materials, std::move(material));
}

int GlbModel::add_camera(tinygltf::Camera camera) {
  return push(model_.cameras, std::move(camera));
}

int GlbModel::add_node(tinygltf::Node node) {
  return push(model_.nodes, std::move(node));
}

int GlbModel::add_lamp(tinygltf::Light lamp) {
  return push(model_.lights, std::move(lamp));
}

void GlbModel::add_root(int node) {
  model_.scenes[0].nodes.push_back(node);
}

int GlbModel::add_mesh(tinygltf::Mesh mesh) {
  return push(model_.meshes, std::move(mesh));
}

int GlbModel::add_mesh_node(tinygltf::Mesh mesh) {
  tinygltf::Node node;
  node.name = mesh.name;
  node.mesh = add_mesh(std::move(mesh));
  return add_node(std::move(node));
}

template <typename Vector>
int GlbModel::add_vectors(const std::vector<Vector>& values, int type) {
  return add_accessor(values.data(), values.size(), sizeof(Vector), TINYGLTF_COMPONENT_TYPE_FLOAT, type,
                      TINYGLTF_TARGET_ARRAY_BUFFER);
}

int GlbModel::add_positions(const std::vector<glm::vec3>& positions) {
  glm::vec3 low = positions.front(), high = low;
  for (const glm::vec3& position : positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  const int accessor = add_vectors(positions, TINYGLTF_TYPE_VEC3);
  model_.accessors.back().minValues = {low.x, low.y, low.z};
  model_.accessors.back().maxValues = {high.x, high.y, high.z};
  return accessor;
}

int GlbModel::add_attribute(const std::vector<glm::vec2>& values) {
  return add_vectors(values, TINYGLTF_TYPE_VEC2);
}

int GlbModel::add_attribute(const std::vector<glm::vec3>& values) {
  return add_vectors(values, TINYGLTF_TYPE_VEC3);
}

int GlbModel::add_attribute(const std::vector<glm::vec4>& values) {
  return add_vectors(values, TINYGLTF_TYPE_VEC4);
}

int GlbModel::add_png(const std::string& name, std::span<const std::byte> bytes) {
  tinygltf::Image image;
  image.name = name;
  image.mimeType = "image/png";
  image.bufferView = add_view(bytes.data(), bytes.size(), 0);
  return push(model_.images, std::move(image));
}

int GlbModel::add_texture(int image, tinygltf::Sampler sampler) {
  tinygltf::Texture texture;
  texture.source = image;
  texture.sampler = push(model_.samplers, std::move(sampler));
  return push(model_.textures, std::move(texture));
}

tinygltf::Primitive GlbModel::primitive(int mode, int positions, const std::vector<std::uint32_t>& indices,
                                        int material) {
  tinygltf::Primitive primitive;
  primitive.mode = mode;
  primitive.material = material;
  primitive.attributes["POSITION"] = positions;
  primitive.indices =
      add_accessor(indices.data(), indices.size(), sizeof(std::uint32_t), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                   TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  return primitive;
}

std::string GlbModel::encoded() {
  std::ostringstream stream;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, stream, false, true)) {
    throw ResourceError("the scene could not be encoded as GLB");
  }
  return std::move(stream).str();
}

int GlbModel::add_view(const void* data, std::size_t length, int target) {
  std::vector<unsigned char>& bytes = model_.buffers[0].data;
  const std::size_t offset = bytes.size(), padded = (length + 3) / 4 * 4;
  if (offset + padded > std::numeric_limits<std::uint32_t>::max() - (std::uint32_t{1} << 24)) {
    throw InputError("the scene does not fit into a GLB, which holds at most 4 GiB; write .json or .obj");
  }
  bytes.resize(offset + padded);
  std::memcpy(bytes.data() + offset, data, length);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = offset;
  view.byteLength = length;
  view.target = target;
  return push(model_.bufferViews, std::move(view));
}

int GlbModel::add_accessor(const void* data, std::size_t count, std::size_t stride, int component_type, int type,
                           int target) {
  tinygltf::Accessor accessor;
  accessor.bufferView = add_view(data, count * stride, target);
  accessor.componentType = component_type;
  accessor.count = count;
  accessor.type = type;
  return push(model_.accessors, std::move(accessor));
}

}  // namespace penumbra::scenes
