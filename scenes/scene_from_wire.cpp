// The program's end of the wire: what the import helper answers about scenes and textures, checked.

#include "scenes/scene_wire.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

namespace penumbra::scenes {
namespace {

using mesh::WireError;
using mesh::WireReader;

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

Scene get_scene(WireReader& from) {
  Scene scene;
  scene.name = from.get_string();
  scene.width = from.get<std::uint32_t>();
  scene.height = from.get<std::uint32_t>();
  scene.soup = mesh::get_soup(from);
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
