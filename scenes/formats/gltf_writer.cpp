// SPDX-License-Identifier: Apache-2.0
// Writes a scene as binary glTF: objects as meshes in world space, flat lights as emissive meshes, spheres and suns as
// lamps of KHR_lights_punctual, and extras for properties that glTF does not have.

#include "scenes/formats/checks.hpp"
#include "scenes/formats/glb_model.hpp"
#include "scenes/formats/lights/light_formats.hpp"
#include "scenes/light_texture.hpp"
#include "scenes/formats/writers.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/png.hpp"
#include "mesh/shapes/shapes.hpp"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>

namespace penumbra::scenes {
namespace {

constexpr const char* kEmissiveStrength = "KHR_materials_emissive_strength";

int wrap_of(PictureUse::Wrap wrap) {
  if (wrap == PictureUse::Wrap::clamp) return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  return wrap == PictureUse::Wrap::mirror ? TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT : TINYGLTF_TEXTURE_WRAP_REPEAT;
}

/// Returns whether glTF has a lamp for the light.
bool is_lamp(const AreaLight& light) {
  return format_of(light.shape).lamp != nullptr;
}

/// Returns whether no object casts a shadow of the light.
bool is_shadeless(const Scene& scene, const AreaLight& light) {
  return !light.unshaded_by.empty() && light.unshaded_by.size() == scene.objects.size();
}

/// Vertex attributes of a mesh.
struct GlbVertices {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals = {};  // these lists are empty or have one element for each vertex
  std::vector<glm::vec4> colors = {};
  std::vector<glm::vec2> places = {};
};

class GlbBuilder {
 public:
  int add_material(const std::string& name, const glm::dvec3& color, const AreaLight* light) {
    return glb_.add_material(material_of(name, color, light));
  }

  int add_material(const Scene& scene, const Object& object) {
    const AreaLight* light = object.emits ? &scene.lights[*object.emits] : nullptr;
    tinygltf::Material material =
        material_of(object.material.empty() ? object.name : object.material, object.color, light);
    material.pbrMetallicRoughness.baseColorFactor[3] = object.alpha.factor;
    if (object.alpha.mode != Alpha::Mode::opaque)
      material.alphaMode = object.alpha.mode == Alpha::Mode::mask ? "MASK" : "BLEND";
    material.alphaCutoff = object.alpha.cutoff;
    if (object.picture) material.pbrMetallicRoughness.baseColorTexture.index = texture_of(scene, *object.picture);
    return glb_.add_material(std::move(material));
  }

  /// Adds a mesh that no node shows yet, and returns its number; `extras` as import/gltf/gltf_extras.hpp reads them.
  int add_mesh(const std::string& name, const GlbVertices& vertices, const std::vector<std::uint32_t>& indices,
               int material, tinygltf::Value::Object extras = {}) {
    PENUMBRA_ASSERT(!vertices.positions.empty() && !indices.empty(), "mesh \"{}\" is empty", name);
    tinygltf::Mesh mesh;
    mesh.name = name;
    auto primitive = glb_.primitive(TINYGLTF_MODE_TRIANGLES, glb_.add_positions(vertices.positions), indices, material);
    const auto add = [&](const char* attribute, const auto& values) {
      if (!values.empty()) primitive.attributes[attribute] = glb_.add_attribute(values);
    };
    add("NORMAL", vertices.normals), add("COLOR_0", vertices.colors), add("TEXCOORD_0", vertices.places);
    mesh.primitives.push_back(std::move(primitive));
    if (!extras.empty()) mesh.extras = tinygltf::Value(std::move(extras));
    return glb_.add_mesh(std::move(mesh));
  }

  /// Adds a node that shows a mesh, placed by `to_world`; null: the mesh's own space is the world.
  void show_mesh(const std::string& name, int mesh, const glm::dmat4* to_world = nullptr) {
    tinygltf::Node node;
    node.name = name;
    node.mesh = mesh;
    for (glm::length_t column = 0; to_world != nullptr && column < 4; ++column) {
      for (glm::length_t row = 0; row < 4; ++row) node.matrix.push_back((*to_world)[column][row]);
    }
    glb_.add_root(glb_.add_node(std::move(node)));
  }

  void add_camera(const Camera& camera, double aspect) {
    tinygltf::Camera gltf;
    gltf.name = camera.name;
    if (camera.height) {
      gltf.type = "orthographic";
      gltf.orthographic.ymag = *camera.height / 2;
      gltf.orthographic.xmag = aspect * gltf.orthographic.ymag;
      gltf.orthographic.znear = 0;
      gltf.orthographic.zfar = 1e6 * *camera.height;  // required by glTF; not used by any reader here
    } else {
      gltf.type = "perspective";
      gltf.perspective.yfov = camera.vertical_fov * std::numbers::pi / 180;
      gltf.perspective.aspectRatio = aspect;
      gltf.perspective.znear = 1e-3 * glm::distance(camera.eye, camera.target);
      gltf.perspective.zfar = 0;  // infinite
    }
    tinygltf::Value::Object extras;
    if (camera.shift != glm::dvec2(0)) {
      extras["shift"] =
          tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(camera.shift.x), tinygltf::Value(camera.shift.y)});
    }
    if (camera.lens) {
      extras["aperture"] = tinygltf::Value(camera.lens->radius);
      extras["focusDistance"] = tinygltf::Value(camera.lens->focus_distance);
    }
    if (!extras.empty()) gltf.extras = tinygltf::Value(extras);
    // A glTF camera looks along its −Z with +Y up.
    const glm::dvec3 back = glm::normalize(camera.eye - camera.target);
    const glm::dvec3 right = glm::normalize(glm::cross(camera.up, back)), up = glm::cross(back, right);
    tinygltf::Node node;
    node.name = camera.name;
    node.camera = glb_.add_camera(std::move(gltf));
    node.matrix = {right.x, right.y, right.z, 0, up.x,         up.y,         up.z,         0,
                   back.x,  back.y,  back.z,  0, camera.eye.x, camera.eye.y, camera.eye.z, 1};
    glb_.add_root(glb_.add_node(std::move(node)));
  }

  /// Adds a light for which glTF has a lamp.
  void add_lamp(const AreaLight& light, bool casts_shadows) {
    const GltfLamp made = format_of(light.shape).lamp(light.shape);
    tinygltf::Light lamp;
    lamp.name = light.name;
    lamp.type = made.type;
    glm::dvec3 intensity = light.radiance * made.intensity;
    tinygltf::Value::Object extras;
    extras[made.size.first] = tinygltf::Value(made.size.second);
    if (made.cone) {
      lamp.spot.innerConeAngle = made.cone->inner * std::numbers::pi / 180;
      lamp.spot.outerConeAngle = made.cone->outer * std::numbers::pi / 180;
      if (made.cone->smooth) extras["smooth"] = tinygltf::Value(1);
    }
    // The colour is at most 1; the intensity carries the rest.
    lamp.intensity = std::max({intensity.x, intensity.y, intensity.z});
    if (lamp.intensity > 0) intensity /= lamp.intensity;
    lamp.color = {intensity.x, intensity.y, intensity.z};
    lamp.extras = tinygltf::Value(extras);
    // A lamp shines along its −Z.
    const glm::dvec3 back = -glm::normalize(made.direction),
                     aside = std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(aside, back)), up = glm::cross(back, right);
    tinygltf::Node node;
    node.name = light.name;
    node.matrix = {right.x,         right.y,         right.z,         0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0,
                   made.position.x, made.position.y, made.position.z, 1};
    if (!casts_shadows) node.extras = tinygltf::Value(tinygltf::Value::Object{{"castsShadow", tinygltf::Value(false)}});
    node.extensions["KHR_lights_punctual"] =
        tinygltf::Value(tinygltf::Value::Object{{"light", tinygltf::Value(glb_.add_lamp(std::move(lamp)))}});
    glb_.add_root(glb_.add_node(std::move(node)));
  }

  std::string finish() {
    if (uses_emissive_strength_) glb_.uses_extension(kEmissiveStrength);
    return glb_.encoded();
  }

 private:
  tinygltf::Material material_of(const std::string& name, const glm::dvec3& color, const AreaLight* light) {
    tinygltf::Material material;
    material.name = name;
    material.pbrMetallicRoughness.baseColorFactor = {color.x, color.y, color.z, 1};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 1;
    if (light != nullptr) {
      // The factor is at most 1; the strength carries the rest.
      const glm::dvec3 radiance = light->radiance * (light->texture ? mean_color(*light->texture) : glm::dvec3(1));
      const double strength = std::max({radiance.x, radiance.y, radiance.z});
      const glm::dvec3 factor = strength > 0 ? radiance / strength : glm::dvec3(0);
      material.emissiveFactor = {factor.x, factor.y, factor.z};
      material.extensions[kEmissiveStrength] =
          tinygltf::Value(tinygltf::Value::Object{{"emissiveStrength", tinygltf::Value(strength)}});
      material.doubleSided = light->two_sided;
      uses_emissive_strength_ = true;
    }
    return material;
  }

  int texture_of(const Scene& scene, const PictureUse& use) {
    const auto [image, is_new_image] = images_.try_emplace(use.picture);
    if (is_new_image) {
      const Picture& picture = scene.pictures[use.picture];
      image->second =
          glb_.add_png(picture.file, encode_rgba_png(RgbaImage{picture.width, picture.height, picture.texels}));
    }
    const auto [texture, is_new] = textures_.try_emplace({use.picture, use.wrap_s, use.wrap_t, use.nearest});
    if (is_new) {
      tinygltf::Sampler sampler;
      sampler.wrapS = wrap_of(use.wrap_s);
      sampler.wrapT = wrap_of(use.wrap_t);
      sampler.magFilter = use.nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
      texture->second = glb_.add_texture(image->second, std::move(sampler));
    }
    return texture->second;
  }

  GlbModel glb_;
  std::map<std::uint32_t, int> images_;  // indices of the scene's pictures in the file
  std::map<std::tuple<std::uint32_t, PictureUse::Wrap, PictureUse::Wrap, bool>, int> textures_;
  bool uses_emissive_strength_ = false;
};

/// Adds a mesh of some of the soup's triangles, with an object's surface, and returns its number. `looks` are those of
/// the soup's vertices.
int add_object(const Scene& scene, const mesh::TriangleSoup& soup, const VertexLooks& looks, const ObjectRange& range,
               GlbBuilder& glb) {
  const Object& object = scene.objects[range.object];
  GlbVertices vertices;
  std::vector<std::uint32_t> indices;
  std::unordered_map<std::uint32_t, std::uint32_t> local;  // maps the soup's vertices to those of this mesh
  const auto add = [](auto& to, const auto& from, std::uint32_t vertex) {
    if (!from.empty()) to.emplace_back(from[vertex]);
  };
  for (std::size_t i = range.first; i < range.first + range.count; ++i) {
    for (const std::uint32_t vertex : soup.triangles[i]) {
      const auto [entry, is_new] = local.try_emplace(vertex, static_cast<std::uint32_t>(vertices.positions.size()));
      indices.push_back(entry->second);
      if (!is_new) continue;
      vertices.positions.emplace_back(soup.positions[vertex]);
      add(vertices.normals, looks.normals, vertex);
      add(vertices.colors, looks.colors, vertex);
      if (object.picture) add(vertices.places, looks.places, vertex);
    }
  }
  const auto drop_plain = [](auto& values, const auto& plain) {
    if (std::ranges::all_of(values, [&](const auto& value) { return value == plain; })) values.clear();
  };
  drop_plain(vertices.normals, glm::vec3(0));
  drop_plain(vertices.colors, glm::vec4(1));
  const AreaLight* light = object.emits ? &scene.lights[*object.emits] : nullptr;
  tinygltf::Value::Object extras;
  if (!object.casts_shadow) extras["castsShadow"] = tinygltf::Value(false);
  if (!object.receives_shadow) extras["receivesShadow"] = tinygltf::Value(false);
  if (light != nullptr && light->name != object.name) extras["lightName"] = tinygltf::Value(light->name);
  return glb.add_mesh(object.name, vertices, indices, glb.add_material(scene, object), std::move(extras));
}

/// Adds the meshes of instances, each mesh once for each surface with which it occurs.
class SharedGlbMeshes {
 public:
  SharedGlbMeshes(const Scene& scene, const Instances& instances, GlbBuilder& glb)
      : scene_(scene), instances_(instances), glb_(glb) {}

  void add(const Instance& instance) {
    const Object& object = scene_.objects[instance.object];
    const auto [begin, end] = added_.equal_range(instance.mesh);
    auto same = std::find_if(
        begin, end, [&](const auto& entry) { return same_surface(scene_.objects[entry.second.object], object); });
    if (same == end) same = added_.emplace(instance.mesh, Added{instance.object, add_mesh(instance)});
    glb_.show_mesh(object.name, same->second.mesh, &instance.placement.to_world);
  }

 private:
  struct Added {
    std::uint32_t object;
    int mesh;
  };

  int add_mesh(const Instance& instance) {
    const SharedMesh& mesh = *instances_.meshes[instance.mesh];
    const VertexLooks looks{{mesh.normals.begin(), mesh.normals.end()}, mesh.colors, mesh.places};
    return add_object(scene_, mesh.soup, looks, {instance.object, 0, mesh.soup.triangles.size()}, glb_);
  }

  const Scene& scene_;
  const Instances& instances_;
  GlbBuilder& glb_;
  std::multimap<std::uint32_t, Added> added_;
};

/// Adds all pieces as one mesh; spheres become polyhedra of the same area.
void add_pieces(const AreaLight& light, const Pieces& shape, GlbBuilder& glb, Notes& notes) {
  constexpr std::uint32_t kSubdivisions = 3;
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  bool round = false;
  for (const Pieces::Piece& piece : shape.pieces) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    if (const auto* sphere = std::get_if<Sphere>(&piece)) {
      round = true;
      const mesh::TriangleSoup unit = mesh::make_icosphere(glm::dvec3(0), 1, kSubdivisions);
      double area = 0;
      for (const auto& [a, b, c] : unit.triangles) {
        const glm::dvec3& from = unit.positions[a];
        area += glm::length(glm::cross(unit.positions[b] - from, unit.positions[c] - from)) / 2;
      }
      const double radius = sphere->radius * std::sqrt(4 * std::numbers::pi / area);
      const mesh::TriangleSoup ball = mesh::make_icosphere(sphere->center, radius, kSubdivisions);
      positions.insert(positions.end(), ball.positions.begin(), ball.positions.end());
      for (const mesh::Triangle& t : ball.triangles)
        indices.insert(indices.end(), {first + t[0], first + t[1], first + t[2]});
    } else {
      const LightShape flat = std::visit([](const auto& its) { return LightShape(its); }, piece);
      const std::vector<glm::dvec3> corners = format_of(flat).outline(flat);
      positions.insert(positions.end(), corners.begin(), corners.end());
      for (std::uint32_t i = 1; i + 1 < corners.size(); ++i)
        indices.insert(indices.end(), {first, first + i, first + i + 1});
    }
  }
  if (round)
    notes.push_back(fmt::format("light \"{}\": its spheres are written with {} flat sides", light.name,
                                mesh::icosphere_size(kSubdivisions).triangles));
  glb.show_mesh(light.name, glb.add_mesh(light.name, {.positions = std::move(positions)}, indices,
                                         glb.add_material(light.name, glm::dvec3(0.8), &light),
                                         {{"body", tinygltf::Value(false)}}));
}

void add_light(const Scene& scene, const AreaLight& light, GlbBuilder& glb, Notes& notes) {
  if (const auto* pieces = std::get_if<Pieces>(&light.shape)) return add_pieces(light, *pieces, glb, notes);
  if (is_lamp(light)) return glb.add_lamp(light, !is_shadeless(scene, light));
  const std::vector<glm::dvec3> points = format_of(light.shape).outline(light.shape);
  if (is_round(kind_of(light.shape).value())) {
    notes.push_back(
        fmt::format("light \"{}\": glTF has no round lights; written with {} sides", light.name, kRimSides));
  }
  std::vector<std::uint32_t> fan;
  for (std::uint32_t i = 1; i + 1 < points.size(); ++i) fan.insert(fan.end(), {0, i, i + 1});
  glb.show_mesh(light.name, glb.add_mesh(light.name, {.positions = {points.begin(), points.end()}}, fan,
                                         glb.add_material(light.name, glm::dvec3(0.8), &light),
                                         {{"body", tinygltf::Value(false)}}));
}

}  // namespace

void write_glb(const Scene& scene, const Instances& instances, AtomicFile& file, Losses& losses, Notes& notes) {
  GlbBuilder glb;
  SharedGlbMeshes shared(scene, instances, glb);
  std::vector<int> bodies(scene.lights.size());
  const auto count_body = [&](std::uint32_t object) {
    if (const auto light = scene.objects[object].emits) ++bodies[*light];
  };
  for_each_mesh(
      scene, instances,
      [&](const ObjectRange& range) {
        glb.show_mesh(scene.objects[range.object].name, add_object(scene, scene.soup, scene.looks, range, glb));
        count_body(range.object);
      },
      [&](const Instance& instance) {
        shared.add(instance);
        count_body(instance.object);
      });
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (bodies[i] > 1)
      notes.push_back(fmt::format("light \"{}\": each of the {} meshes of its body becomes a separate light in glTF",
                                  scene.lights[i].name, bodies[i]));
    if (bodies[i] > 0) continue;
    if (std::holds_alternative<Dome>(scene.lights[i].shape)) {
      losses.refuse("is a dome, which glTF does not have", scene.lights[i].name);
      continue;
    }
    if (scene.lights[i].radiance == glm::dvec3(0))  // its outline would be read back as a surface that casts a shadow
      notes.push_back(fmt::format("light \"{}\" is dark: glTF has no such lights; left out", scene.lights[i].name));
    else
      add_light(scene, scene.lights[i], glb, notes);
  }
  for (const AreaLight& light : scene.lights) {
    if (!light.texture || std::holds_alternative<Dome>(light.shape)) continue;
    notes.push_back(fmt::format("light \"{}\": its texture is replaced by its mean colour", light.name));
  }
  for (const Camera& camera : scene.cameras) {
    glb.add_camera(camera, camera.aspect.value_or(static_cast<double>(scene.width) / scene.height));
  }
  for (const Object& object : scene.objects) {
    if (object.lit_by) losses.refuse("is lit only by some lights, which glTF cannot express", object.name);
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const AreaLight& light = scene.lights[i];
    if (!light.unshaded_by.empty() && !(bodies[i] == 0 && is_lamp(light) && is_shadeless(scene, light)))
      losses.refuse("has shadows only of some meshes, which glTF cannot express", light.name);
  }
  file.write(glb.finish());
}

}  // namespace penumbra::scenes
