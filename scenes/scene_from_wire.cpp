// SPDX-License-Identifier: Apache-2.0
// The program's end of the wire: decodes and checks the import helper's scenes and textures.

#include "scenes/scene_fields.hpp"
#include "scenes/scene_wire.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

namespace penumbra::scenes {
namespace {

using mesh::WireError;

/// Last values of enumerations, which begin at 0.
constexpr auto kLast = std::tuple(PictureUse::Wrap::clamp, Alpha::Mode::blend);

template <typename T>
concept IsEnum = std::is_enum_v<T>;

template <typename T>
bool is_finite(const T& number) {
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(number);
  return true;
}
template <glm::length_t N, typename T>
bool is_finite(const glm::vec<N, T>& v) {
  for (glm::length_t i = 0; i < N; ++i) {
    if (!is_finite(v[i])) return false;
  }
  return true;
}

bool is_finite(const glm::dmat4& matrix) {
  return is_finite(matrix[0]) && is_finite(matrix[1]) && is_finite(matrix[2]) && is_finite(matrix[3]);
}

template <typename T>
void check(const T& /*part*/) {}

void check(const SharedMesh& mesh) {
  if (mesh.soup.triangles.empty()) throw WireError("a mesh of instances has no triangles");
  for (const std::size_t looks : {mesh.normals.size(), mesh.colors.size(), mesh.places.size()}) {
    if (looks != 0 && looks != mesh.soup.positions.size()) throw WireError("the number of vertex attributes is wrong");
  }
}

void check(const Polygon& polygon) {
  if (polygon.vertices.size() < 3) throw WireError("a polygon has fewer than three corners");
}

void check(const Pieces& shape) {
  if (shape.pieces.empty()) throw WireError("a light has no pieces");
}

void check(const Picture& picture) {
  if (picture.texels.empty() || picture.texels.size() != std::uint64_t{picture.width} * picture.height) {
    throw WireError("a picture has more or fewer texels than its size says");
  }
}

void check(const Scene& scene) {
  for (const std::size_t looks : {scene.looks.normals.size(), scene.looks.colors.size(), scene.looks.places.size()}) {
    if (looks != 0 && looks != scene.soup.positions.size()) throw WireError("the number of vertex attributes is wrong");
  }
  for (const std::uint32_t object : scene.soup.object) {
    if (object >= scene.objects.size()) throw WireError("a triangle belongs to no object");
  }
  for (const Object& object : scene.objects) {
    if (object.emits && *object.emits >= scene.lights.size()) throw WireError("an object emits an unknown light");
    if (object.picture && object.picture->picture >= scene.pictures.size()) throw WireError("a picture is missing");
  }
  for (const AreaLight& light : scene.lights) {
    for (const std::uint32_t object : light.unshaded_by) {
      if (object >= scene.objects.size()) throw WireError("a light names an object that does not exist");
    }
  }
}

/// Reads values that Put (scene_wire.cpp) wrote; checks that every number is finite and every enumerator valid.
struct Get {
  mesh::WireReader& from;

  void operator()(bool& value) const { value = from.get_bool(); }
  void operator()(std::string& text) const { text = from.get_string(); }
  void operator()(mesh::TriangleSoup& soup) const { soup = mesh::get_soup(from); }
  template <IsNumber T>
  void operator()(T& number) const {
    number = from.get<T>();
    if (!is_finite(number)) throw WireError("a number is not finite");
  }
  template <IsEnum T>
  requires IsNumber<T>
  void operator()(T& value) const {
    const auto number = from.get<std::underlying_type_t<T>>();
    if (number > static_cast<std::underlying_type_t<T>>(std::get<T>(kLast)))
      throw WireError("an enumerator is out of range");
    value = static_cast<T>(number);
  }
  template <HasFields T>
  void operator()(T& part) const {
    std::apply([&](auto&... field) { ((*this)(field), ...); }, fields_of(part));
    check(part);
  }
  template <typename T>
  void operator()(std::optional<T>& value) const {
    if (from.get_bool()) (*this)(value.emplace());
  }
  template <typename T>
  void operator()(std::shared_ptr<const T>& part) const {
    const auto made = std::make_shared<T>();
    (*this)(*made);
    part = made;
  }
  template <IsNumber T>
  void operator()(std::vector<T>& numbers) const {
    numbers = from.get_array<T>();
    if (!std::ranges::all_of(numbers, [](const T& number) { return is_finite(number); }))
      throw WireError("one of many numbers is not finite");
  }
  /// Reads entry by entry: a false count allocates nothing.
  template <typename T>
  void operator()(std::vector<T>& entries) const {
    const auto count = from.get<std::uint64_t>();
    for (std::uint64_t i = 0; i < count; ++i) (*this)(entries.emplace_back());
  }
  template <typename... Kinds>
  void operator()(std::variant<Kinds...>& one) const {
    const auto kind = from.get<std::uint8_t>();
    if (kind >= sizeof...(Kinds)) throw WireError("a light's shape is unknown");
    get_kind(one, kind, std::index_sequence_for<Kinds...>());
  }

 private:
  template <typename Variant, std::size_t... Kind>
  void get_kind(Variant& one, std::size_t kind, std::index_sequence<Kind...> /*kinds*/) const {
    ((kind == Kind ? (*this)(one.template emplace<Kind>()) : void()), ...);
  }
};

}  // namespace

Scene get_scene(mesh::WireReader& from) {
  Scene scene;
  Get{from}(scene);
  return scene;
}

Instances get_instances(mesh::WireReader& from, const Scene& scene) {
  Instances instances;
  Get{from}(instances);
  std::uint64_t before = 0;
  for (const Instance& instance : instances.all) {
    if (instance.mesh >= instances.meshes.size() || instance.object >= scene.objects.size())
      throw WireError("an instance refers to no mesh or object");
    if (instance.soup_before < before || instance.soup_before > scene.soup.triangles.size())
      throw WireError("instances are out of order");
    before = instance.soup_before;
  }
  return instances;
}

Texture get_texture(mesh::WireReader& from) {
  Texture texture;
  texture.width = from.get<std::uint32_t>();
  texture.height = from.get<std::uint32_t>();
  texture.texels = from.get_array<glm::vec3>();
  if (texture.texels.size() != std::uint64_t{texture.width} * texture.height) {
    throw WireError("it has more or fewer texels than its size says");
  }
  return texture;
}

}  // namespace penumbra::scenes
