#include "scenes/scene_wire.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
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

/// One of an enumeration's values, which begin at 0.
template <typename Enum>
Enum get_enum(WireReader& from, Enum last) {
  const auto value = from.get<std::uint8_t>();
  if (value > static_cast<std::uint8_t>(last)) throw WireError("a value is none of its kind");
  return static_cast<Enum>(value);
}

std::optional<double> get_optional(WireReader& from) {
  return from.get_bool() ? std::optional(get_number(from)) : std::nullopt;
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
        cone.smooth = from.get_bool();
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
    case 6: {
      Pieces shape;
      const auto count = from.get<std::uint64_t>();
      for (std::uint64_t i = 0; i < count; ++i) {
        const LightShape one = get_shape(from);
        if (const auto* rectangle = std::get_if<Rectangle>(&one))
          shape.pieces.emplace_back(*rectangle);
        else if (const auto* polygon = std::get_if<Polygon>(&one))
          shape.pieces.emplace_back(*polygon);
        else if (const auto* sphere = std::get_if<Sphere>(&one))
          shape.pieces.emplace_back(*sphere);
        else
          throw WireError("a light has a piece of a kind that is none");
      }
      if (shape.pieces.empty()) throw WireError("a light has no pieces");
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
  object.material = from.get_string();
  if (from.get_bool()) {
    PictureUse& use = object.picture.emplace();
    use.picture = from.get<std::uint32_t>();
    use.wrap_s = get_enum(from, PictureUse::Wrap::clamp), use.wrap_t = get_enum(from, PictureUse::Wrap::clamp);
    use.nearest = from.get_bool();
  }
  object.alpha.mode = get_enum(from, Alpha::Mode::blend);
  object.alpha.factor = get_number(from), object.alpha.cutoff = get_number(from);
  return object;
}

/// Without a texture: the formats that come this way have none.
AreaLight get_light(WireReader& from) {
  AreaLight light;
  light.name = from.get_string();
  light.shape = get_shape(from);
  light.radiance = get_vector(from);
  light.two_sided = from.get_bool();
  light.unshaded_by = from.get_array<std::uint32_t>();
  return light;
}

Camera get_camera(WireReader& from) {
  Camera camera;
  camera.name = from.get_string();
  camera.eye = get_vector(from);
  camera.target = get_vector(from);
  camera.up = get_vector(from);
  camera.vertical_fov = get_number(from);
  camera.height = get_optional(from);
  camera.aspect = get_optional(from);
  camera.shift.x = get_number(from), camera.shift.y = get_number(from);
  return camera;
}

Picture get_picture(WireReader& from) {
  Picture picture;
  picture.file = from.get_string();
  picture.width = from.get<std::uint32_t>();
  picture.height = from.get<std::uint32_t>();
  picture.texels = from.get_array<std::array<std::uint8_t, 4>>();
  if (picture.texels.empty() || picture.texels.size() != std::uint64_t{picture.width} * picture.height) {
    throw WireError("a picture has more or fewer texels than its size says");
  }
  return picture;
}

template <typename Vector>
void get_look(WireReader& from, std::vector<Vector>& list, std::size_t positions) {
  list = from.get_array<Vector>();
  if (!list.empty() && list.size() != positions) throw WireError("not every vertex looks like something");
  for (const Vector& value : list) {
    for (glm::length_t i = 0; i < Vector::length(); ++i) {
      if (!std::isfinite(value[i])) throw WireError("a vertex's look is not finite");
    }
  }
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
  to.put_array(std::span<const glm::vec3>(scene.looks.normals));
  to.put_array(std::span<const glm::vec4>(scene.looks.colors));
  to.put_array(std::span<const glm::dvec2>(scene.looks.places));
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
    to.put_array(std::span<const std::array<std::uint8_t, 4>>(picture.texels));
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

Scene get_scene(WireReader& from) {
  Scene scene;
  scene.name = from.get_string();
  scene.width = from.get<std::uint32_t>();
  scene.height = from.get<std::uint32_t>();
  scene.soup.positions = from.get_array<glm::dvec3>();
  scene.soup.triangles = from.get_array<mesh::Triangle>();
  scene.soup.object = from.get_array<std::uint32_t>();
  scene.soup.source_face = from.get_array<std::uint32_t>();
  get_look(from, scene.looks.normals, scene.soup.positions.size());
  get_look(from, scene.looks.colors, scene.soup.positions.size());
  get_look(from, scene.looks.places, scene.soup.positions.size());
  get_entries(from, scene.objects, get_object);
  get_entries(from, scene.pictures, get_picture);
  get_entries(from, scene.lights, get_light);
  get_entries(from, scene.cameras, get_camera);
  if (from.get_bool()) scene.origin = get_vector(from);
  if (from.get_bool()) {
    scene.motion.emplace();
    scene.motion->first = get_number(from), scene.motion->last = get_number(from);
  }
  scene.warnings = from.get_strings();

  mesh::check_soup(scene.soup);
  for (const std::uint32_t object : scene.soup.object) {
    if (object >= scene.objects.size()) throw WireError("a triangle belongs to no object");
  }
  for (const Object& object : scene.objects) {
    if (object.emits && *object.emits >= scene.lights.size()) throw WireError("an object emits an unknown light");
    if (object.picture && object.picture->picture >= scene.pictures.size()) throw WireError("a picture is missing");
  }
  for (const AreaLight& light : scene.lights) {
    for (const std::uint32_t object : light.unshaded_by) {
      if (object >= scene.objects.size()) throw WireError("a light is not shaded by an object that is none");
    }
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
