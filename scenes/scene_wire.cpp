// SPDX-License-Identifier: Apache-2.0
// Scenes, instances and textures as bytes between the import helper and this process, field by field by the lists of
// scenes/scene_fields.hpp.

#include "scenes/scene_wire.hpp"

#include "scenes/scene_fields.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace penumbra::scenes {
namespace {

/// Writes any type that fields_of supports, or that consists of such types.
struct Put {
  mesh::WireWriter& to;

  void operator()(bool value) const { to.put<std::uint8_t>(value ? 1 : 0); }
  void operator()(const std::string& text) const { to.put_string(text); }
  void operator()(const mesh::TriangleSoup& soup) const { mesh::put_soup(to, soup); }
  void operator()(const IsNumber auto& number) const { to.put(number); }
  void operator()(const HasFields auto& part) const {
    std::apply([&](const auto&... field) { ((*this)(field), ...); }, fields_of(part));
  }
  template <typename T>
  void operator()(const std::optional<T>& value) const {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }
  template <typename T>
  void operator()(const std::shared_ptr<const T>& part) const {
    (*this)(*part);
  }
  template <IsNumber T>
  void operator()(const std::vector<T>& numbers) const {
    to.put_array_in_place(std::span<const T>(numbers));
  }
  /// Each entry takes at least one byte, so that a false count reaches the end of the answer.
  template <typename T>
  void operator()(const std::vector<T>& entries) const {
    to.put<std::uint64_t>(entries.size());
    for (const T& entry : entries) (*this)(entry);
  }
  template <typename... Kinds>
  void operator()(const std::variant<Kinds...>& one) const {
    to.put(static_cast<std::uint8_t>(one.index()));
    std::visit(*this, one);
  }
};

}  // namespace

void put_scene(mesh::WireWriter& to, const Scene& scene) {
  Put{to}(scene);
}

void put_instances(mesh::WireWriter& to, const Instances& instances) {
  Put{to}(instances);
}

void put_texture(mesh::WireWriter& to, const Texture& texture) {
  to.put(texture.width), to.put(texture.height);
  to.put_array_in_place(std::span<const glm::vec3>(texture.texels));
}

}  // namespace penumbra::scenes
