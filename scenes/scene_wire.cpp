#include "scenes/scene_wire.hpp"

#include <cmath>
#include <span>

namespace penumbra::scenes {
namespace {

using mesh::WireError;
using mesh::WireReader;
using mesh::WireWriter;

glm::dvec3 get_vector(WireReader& from) {
  const auto v = from.get<glm::dvec3>();
  if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) throw WireError("a vector is not finite");
  return v;
}

double get_number(WireReader& from) {
  const auto value = from.get<double>();
  if (!std::isfinite(value)) throw WireError("a number is not finite");
  return value;
}

void put_bool(WireWriter& to, bool value) {
  to.put<std::uint8_t>(value ? 1 : 0);
}

/// How many entries follow; each takes at least one byte, so that a false count runs into the end of the answer.
void put_count(WireWriter& to, std::size_t count) {
  to.put<std::uint64_t>(count);
}

struct PutShape {
  WireWriter& to;
  void operator()(const Rectangle& shape) const { to.put(shape.center), to.put(shape.half_u), to.put(shape.half_v); }
  void operator()(const Disk& shape) const { to.put(shape.center), to.put(shape.normal), to.put(shape.radius); }
  void operator()(const Polygon& shape) const { to.put_array(std::span<const glm::dvec3>(shape.vertices)); }
  void operator()(const Sphere& shape) const {
    to.put(shape.center), to.put(shape.radius), put_bool(to, shape.cone.has_value());
    if (shape.cone) to.put(shape.cone->direction), to.put(shape.cone->inner), to.put(shape.cone->outer);
  }
  void operator()(const Ellipse& shape) const { to.put(shape.center), to.put(shape.half_u), to.put(shape.half_v); }
  void operator()(const Sun& shape) const { to.put(shape.direction), to.put(shape.angle); }
};

LightShape get_shape(WireReader& from) {
  switch (from.get<std::uint8_t>()) {
    case 0: {
      Rectangle shape;
      shape.center = get_vector(from), shape.half_u = get_vector(from), shape.half_v = get_vector(from);
      return shape;
    }
    case 1: {
      Disk shape;
      shape.center = get_vector(from), shape.normal = get_vector(from), shape.radius = get_number(from);
      return shape;
    }
    case 2: {
      Polygon shape{from.get_array<glm::dvec3>()};
      for (const glm::dvec3& v : shape.vertices) {
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
          throw WireError("a corner is not finite");
      }
      if (shape.vertices.size() < 3) throw WireError("a polygon has fewer than three corners");
      return shape;
    }
    case 3: {
      Sphere shape;
      shape.center = get_vector(from), shape.radius = get_number(from);
      if (from.get_bool()) {
        Cone& cone = shape.cone.emplace();
        cone.direction = get_vector(from), cone.inner = get_number(from), cone.outer = get_number(from);
      }
      return shape;
    }
    case 4: {
      Ellipse shape;
      shape.center = get_vector(from), shape.half_u = get_vector(from), shape.half_v = get_vector(from);
      return shape;
    }
    case 5: {
      Sun shape;
      shape.direction = get_vector(from), shape.angle = get_number(from);
      return shape;
    }
    default:
      throw WireError("a light's shape is unknown");
  }
}

Object get_object(WireReader& from) {
  Object object;
  object.name = from.get_string();
  object.color = get_vector(from);
  object.casts_shadow = from.get_bool();
  object.receives_shadow = from.get_bool();
  if (from.get_bool()) object.emits = from.get<std::uint32_t>();
  return object;
}

/// Without a texture: the formats that come this way have none.
AreaLight get_light(WireReader& from) {
  AreaLight light;
  light.name = from.get_string();
  light.shape = get_shape(from);
  light.radiance = get_vector(from);
  light.two_sided = from.get_bool();
  return light;
}

Camera get_camera(WireReader& from) {
  Camera camera;
  camera.name = from.get_string();
  camera.eye = get_vector(from);
  camera.target = get_vector(from);
  camera.up = get_vector(from);
  camera.vertical_fov = get_number(from);
  return camera;
}

template <typename Entry>
void get_entries(WireReader& from, std::vector<Entry>& entries, Entry (*get)(WireReader&)) {
  const auto count = from.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) entries.push_back(get(from));
}

}  // namespace

void put_scene(WireWriter& to, const Scene& scene) {
  to.put_string(scene.name);
  to.put(scene.width), to.put(scene.height);
  to.put_array(std::span<const glm::dvec3>(scene.soup.positions));
  to.put_array(std::span<const mesh::Triangle>(scene.soup.triangles));
  to.put_array(std::span<const std::uint32_t>(scene.soup.object));
  to.put_array(std::span<const std::uint32_t>(scene.soup.source_face));
  put_count(to, scene.objects.size());
  for (const Object& object : scene.objects) {
    to.put_string(object.name);
    to.put(object.color);
    put_bool(to, object.casts_shadow), put_bool(to, object.receives_shadow), put_bool(to, object.emits.has_value());
    if (object.emits) to.put(*object.emits);
  }
  put_count(to, scene.lights.size());
  for (const AreaLight& light : scene.lights) {
    to.put_string(light.name);
    to.put(static_cast<std::uint8_t>(light.shape.index()));
    std::visit(PutShape{to}, light.shape);
    to.put(light.radiance);
    put_bool(to, light.two_sided);
  }
  put_count(to, scene.cameras.size());
  for (const Camera& camera : scene.cameras) {
    to.put_string(camera.name);
    to.put(camera.eye), to.put(camera.target), to.put(camera.up), to.put(camera.vertical_fov);
  }
  to.put_strings(scene.warnings);
}

Scene get_scene(WireReader& from) {
  Scene scene;
  scene.name = from.get_string();
  scene.width = from.get<std::uint32_t>();
  scene.height = from.get<std::uint32_t>();
  scene.soup.positions = from.get_array<glm::dvec3>();
  scene.soup.triangles = from.get_array<mesh::Triangle>();
  scene.soup.object = from.get_array<std::uint32_t>();
  scene.soup.source_face = from.get_array<std::uint32_t>();
  get_entries(from, scene.objects, get_object);
  get_entries(from, scene.lights, get_light);
  get_entries(from, scene.cameras, get_camera);
  scene.warnings = from.get_strings();

  mesh::check_soup(scene.soup);
  for (const std::uint32_t object : scene.soup.object) {
    if (object >= scene.objects.size()) throw WireError("a triangle belongs to no object");
  }
  for (const Object& object : scene.objects) {
    if (object.emits && *object.emits >= scene.lights.size()) throw WireError("an object emits an unknown light");
  }
  if (scene.cameras.empty()) throw WireError("there is no camera");
  return scene;
}

void put_texture(WireWriter& to, const Texture& texture) {
  to.put(texture.width), to.put(texture.height);
  to.put_array(std::span<const glm::vec3>(texture.texels));
}

Texture get_texture(WireReader& from) {
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
