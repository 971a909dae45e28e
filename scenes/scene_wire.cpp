#include "scenes/scene_wire.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace penumbra::scenes {
namespace {

using mesh::WireWriter;

void put_bool(WireWriter& to, bool value) {
  to.put<std::uint8_t>(value ? 1 : 0);
}

void put_optional(WireWriter& to, const std::optional<double>& value) {
  put_bool(to, value.has_value());
  if (value) to.put(*value);
}

/// How many entries follow; each takes at least one byte, so that a false count runs into the end of the answer.
void put_count(WireWriter& to, std::size_t count) {
  to.put<std::uint64_t>(count);
}

void put_shape(WireWriter& to, const LightShape& shape);

struct PutShape {
  WireWriter& to;
  void operator()(const Rectangle& shape) const { to.put(shape.center), to.put(shape.half_u), to.put(shape.half_v); }
  void operator()(const Disk& shape) const { to.put(shape.center), to.put(shape.normal), to.put(shape.radius); }
  void operator()(const Polygon& shape) const { to.put_array(std::span<const glm::dvec3>(shape.vertices)); }
  void operator()(const Sphere& shape) const {
    to.put(shape.center), to.put(shape.radius), put_bool(to, shape.cone.has_value());
    if (!shape.cone) return;
    to.put(shape.cone->direction), to.put(shape.cone->inner), to.put(shape.cone->outer);
    put_bool(to, shape.cone->smooth);
  }
  void operator()(const Ellipse& shape) const { to.put(shape.center), to.put(shape.half_u), to.put(shape.half_v); }
  void operator()(const Sun& shape) const { to.put(shape.direction), to.put(shape.angle); }
  void operator()(const Pieces& shape) const {
    put_count(to, shape.pieces.size());
    for (const Pieces::Piece& piece : shape.pieces) {
      std::visit([&](const auto& one) { put_shape(to, one); }, piece);
    }
  }
};

void put_shape(WireWriter& to, const LightShape& shape) {
  to.put(static_cast<std::uint8_t>(shape.index()));
  std::visit(PutShape{to}, shape);
}

}  // namespace

void put_scene(WireWriter& to, const Scene& scene) {
  to.put_string(scene.name);
  to.put(scene.width), to.put(scene.height);
  mesh::put_soup(to, scene.soup);
  to.put_array_in_place(std::span<const glm::vec3>(scene.looks.normals));
  to.put_array_in_place(std::span<const glm::vec4>(scene.looks.colors));
  to.put_array_in_place(std::span<const glm::dvec2>(scene.looks.places));
  put_count(to, scene.objects.size());
  for (const Object& object : scene.objects) {
    to.put_string(object.name);
    to.put(object.color);
    put_bool(to, object.casts_shadow), put_bool(to, object.receives_shadow), put_bool(to, object.emits.has_value());
    if (object.emits) to.put(*object.emits);
    to.put_string(object.material);
    put_bool(to, object.picture.has_value());
    if (object.picture) {
      to.put(object.picture->picture), to.put(object.picture->wrap_s), to.put(object.picture->wrap_t);
      put_bool(to, object.picture->nearest);
    }
    to.put(object.alpha.mode), to.put(object.alpha.factor), to.put(object.alpha.cutoff);
  }
  put_count(to, scene.pictures.size());
  for (const Picture& picture : scene.pictures) {
    to.put_string(picture.file);
    to.put(picture.width), to.put(picture.height);
    to.put_array_in_place(std::span<const std::array<std::uint8_t, 4>>(picture.texels));
  }
  put_count(to, scene.lights.size());
  for (const AreaLight& light : scene.lights) {
    to.put_string(light.name);
    put_shape(to, light.shape);
    to.put(light.radiance);
    put_bool(to, light.two_sided);
    to.put_array(std::span<const std::uint32_t>(light.unshaded_by));
  }
  put_count(to, scene.cameras.size());
  for (const Camera& camera : scene.cameras) {
    to.put_string(camera.name);
    to.put(camera.eye), to.put(camera.target), to.put(camera.up), to.put(camera.vertical_fov);
    put_optional(to, camera.height), put_optional(to, camera.aspect);
    to.put(camera.shift.x), to.put(camera.shift.y);
  }
  put_bool(to, scene.origin.has_value());
  if (scene.origin) to.put(*scene.origin);
  put_bool(to, scene.motion.has_value());
  if (scene.motion) to.put(scene.motion->first), to.put(scene.motion->last);
  to.put_strings(scene.warnings);
}

void put_texture(WireWriter& to, const Texture& texture) {
  to.put(texture.width), to.put(texture.height);
  to.put_array_in_place(std::span<const glm::vec3>(texture.texels));
}

}  // namespace penumbra::scenes
