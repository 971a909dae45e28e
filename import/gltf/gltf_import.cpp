#include "import/gltf/gltf_import.hpp"

#include "base/error.hpp"
#include "import/gltf/flat_light.hpp"
#include "import/gltf/gltf_accessor.hpp"
#include "import/gltf/gltf_load.hpp"
#include "import/gltf/gltf_nodes.hpp"
#include "import/gltf/punctual_lights.hpp"

#include <tiny_gltf.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>

namespace penumbra::scenes {
namespace {

/// A name that nobody has yet: `wanted`, or `wanted.2`, `wanted.3` …
std::string unique_name(std::set<std::string>& taken, const std::string& wanted) {
  std::string name = wanted;
  for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}.{}", wanted, i);
  return name;
}

/// The triangles of a primitive as indices into its vertices, wound as glTF 2.0, 3.7.2.1 says; `leftover` counts the
/// indices at the end that make no triangle.
std::vector<mesh::Triangle> assemble(int mode, std::span<const std::uint32_t> v, std::uint64_t& leftover) {
  std::vector<mesh::Triangle> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) triangles.push_back({v[i], v[i + 1], v[i + 2]});
    leftover += v.size() % 3;
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      triangles.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    else
      triangles.push_back({v[i + 1], v[i + 2], v[0]});
  }
  if (v.size() < 3) leftover += v.size();
  return triangles;
}

glm::dvec3 checked_factor(const std::vector<double>& numbers, glm::dvec3 otherwise, const std::string& place) {
  if (numbers.size() < 3) return otherwise;
  const glm::dvec3 factor(numbers[0], numbers[1], numbers[2]);
  for (glm::length_t i = 0; i < 3; ++i) {
    if (!std::isfinite(factor[i]) || factor[i] < 0)
      throw InputError("{}: {} is not a colour; expected 0 or more", place, factor[i]);
  }
  return factor;
}

/// What the file is read for.
enum class Purpose { lit_scene, any_scene, mesh };

/// Builds the scene from a parsed model, node by node.
class GltfImport {
 public:
  GltfImport(const tinygltf::Model& model, std::string name, Purpose purpose, const ReadOptions& options)
      : model_(model), purpose_(purpose), lamps_(model, options) {
    scene_.name = std::move(name);
  }

  Scene run() {
    for (const PlacedNode& placed : place_nodes(model_, scene_.warnings)) {
      const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(placed.number)];
      const std::string name = node.name.empty() ? fmt::format("node {}", placed.number) : node.name;
      if (node.mesh >= 0) add_mesh(node, placed, name);
      if (purpose_ == Purpose::mesh) continue;
      if (node.camera >= 0) add_camera(node, placed, name);
      if (node.extensions.contains("KHR_lights_punctual")) add_lamp(node, placed, name);
    }
    if (scene_.soup.triangles.empty()) {
      throw InputError(
          "there are no triangles in the scene ({} primitives of points or lines, {} without POSITION, {} with "
          "fewer than three vertices)",
          points_and_lines_, without_positions_, without_triangles_);
    }
    if (scene_.lights.empty() && purpose_ == Purpose::lit_scene) {
      throw InputError(
          "there is no light in the scene. In Blender, add a plane, turn its front to the scene and give it a "
          "material with emission (Emission Strength above 0), or add a point, spot or sun lamp and export with "
          "Punctual Lights (area lamps are lost in glTF){}",
          refused_lights_.empty() ? "" : "; emissive but no light: " + refused_lights_);
    }
    if (scene_.cameras.empty() && purpose_ != Purpose::mesh) add_camera_that_sees_all();
    add_warnings();
    return std::move(scene_);
  }

 private:
  void add_mesh(const tinygltf::Node& node, const PlacedNode& placed, const std::string& name) {
    if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) {
      throw InputError("/nodes/{}/mesh: mesh {} does not exist; there are {}", placed.number, node.mesh,
                       model_.meshes.size());
    }
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const std::string place = fmt::format("/meshes/{}/primitives/{}", node.mesh, i);
      add_primitive(mesh.primitives[i], placed, place,
                    mesh.primitives.size() > 1 ? fmt::format("{}/{}", name, i) : name);
    }
    if (node.skin >= 0) ++skinned_;
  }

  void add_primitive(const tinygltf::Primitive& primitive, const PlacedNode& placed, const std::string& place,
                     const std::string& name) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) throw InputError("{}/mode: {}; expected 0 to 6", place, mode);
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      ++points_and_lines_;
      return;
    }
    if (primitive.extensions.contains("KHR_draco_mesh_compression")) {
      throw InputError("{}: KHR_draco_mesh_compression is not supported; export without compression", place);
    }
    const auto attribute = primitive.attributes.find("POSITION");
    if (attribute == primitive.attributes.end()) {
      ++without_positions_;
      return;
    }
    const std::vector<glm::dvec3> positions = read_positions(model_, attribute->second);
    std::vector<std::uint32_t> indices;
    if (primitive.indices >= 0) {
      indices = read_indices(model_, primitive.indices);
    } else {
      if (positions.size() > std::numeric_limits<std::uint32_t>::max())
        throw InputError("{}: too many vertices", place);
      for (std::size_t i = 0; i < positions.size(); ++i) indices.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] >= positions.size()) {
        throw InputError("{}: index {} at /accessors/{} names vertex {}, but there are only {}", place, i,
                         primitive.indices, indices[i], positions.size());
      }
    }
    std::vector<mesh::Triangle> triangles = assemble(mode, indices, leftover_indices_);
    if (triangles.empty()) {
      ++without_triangles_;
      return;
    }
    if (!primitive.targets.empty()) ++morphed_;
    add_object(positions, std::move(triangles), placed, {primitive.material, place, unique_name(object_names_, name)});
  }

  struct Look {
    int material;
    std::string place, name;
  };

  /// Adds the triangles in world space, with only the vertices that they use: exporters share one long list of
  /// vertices among many primitives.
  void add_object(std::span<const glm::dvec3> local, std::vector<mesh::Triangle> triangles, const PlacedNode& placed,
                  const Look& look) {
    auto& soup = scene_.soup;
    const auto number = static_cast<std::uint32_t>(scene_.objects.size());
    const std::size_t first_position = soup.positions.size(), first_triangle = soup.triangles.size();
    // A mirroring node turns the front of its triangles (glTF 2.0, 3.7.4); swapped corners turn it back outward.
    const bool mirrored = glm::determinant(glm::dmat3(placed.to_world)) < 0;
    constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> renumbered(local.size(), kUnused);
    for (mesh::Triangle& triangle : triangles) {
      for (std::uint32_t& index : triangle) {
        std::uint32_t& target = renumbered[index];
        if (target == kUnused) {
          if (soup.positions.size() >= kUnused) throw InputError("{}: more than 4,294,967,294 vertices", look.place);
          target = static_cast<std::uint32_t>(soup.positions.size());
          const glm::dvec3 p(placed.to_world * glm::dvec4(local[index], 1));
          if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            throw InputError("{}: vertex {} is not finite after the transform of /nodes/{}", look.place, index,
                             placed.number);
          }
          soup.positions.push_back(p);
        }
        index = target;
      }
      if (mirrored) std::swap(triangle[1], triangle[2]);
      soup.source_face.push_back(static_cast<std::uint32_t>(soup.triangles.size() - first_triangle));
      soup.triangles.push_back(triangle);
      soup.object.push_back(number);
    }
    Object object;
    object.name = look.name;
    object.color = glm::dvec3(1);  // glTF's default material is white
    if (look.material >= 0) {
      const tinygltf::Material& material = find_material(look);
      const auto& surface = material.pbrMetallicRoughness;
      object.color =
          glm::min(checked_factor(surface.baseColorFactor, glm::dvec3(1),
                                  fmt::format("/materials/{}/pbrMetallicRoughness/baseColorFactor", look.material)),
                   glm::dvec3(1));
      if (surface.baseColorTexture.index >= 0) ++textured_;
      object.material = material.name.empty() ? fmt::format("material {}", look.material) : material.name;
      object.emits = add_light(material, look, placed, first_position, first_triangle);
    }
    scene_.objects.push_back(std::move(object));
  }

  const tinygltf::Material& find_material(const Look& look) const {
    if (static_cast<std::size_t>(look.material) >= model_.materials.size()) {
      throw InputError("{}/material: material {} does not exist; there are {}", look.place, look.material,
                       model_.materials.size());
    }
    return model_.materials[static_cast<std::size_t>(look.material)];
  }

  /// The number of the light that the triangles from `first_triangle` on are the body of, if they are one.
  std::optional<std::uint32_t> add_light(const tinygltf::Material& material, const Look& look, const PlacedNode& placed,
                                         std::size_t first_position, std::size_t first_triangle) {
    const std::string place = fmt::format("/materials/{}", look.material);
    glm::dvec3 radiance = checked_factor(material.emissiveFactor, glm::dvec3(0), place + "/emissiveFactor");
    const auto extension = material.extensions.find("KHR_materials_emissive_strength");
    if (extension != material.extensions.end() && extension->second.Has("emissiveStrength")) {
      const tinygltf::Value& strength = extension->second.Get("emissiveStrength");
      const double factor = strength.IsNumber() ? strength.GetNumberAsDouble() : -1;
      if (!std::isfinite(factor) || factor < 0) {
        throw InputError(
            "{}/extensions/KHR_materials_emissive_strength/emissiveStrength: expected a number of 0 or more", place);
      }
      radiance *= factor;
    }
    if (!(radiance.x > 0 || radiance.y > 0 || radiance.z > 0)) return std::nullopt;
    if (purpose_ == Purpose::mesh) {
      ++emissive_;
      return std::nullopt;
    }
    if (material.emissiveTexture.index >= 0) ++emissive_textures_;

    // Files hold single precision: a position is rounded by half a float's step at its distance from the node's
    // origin, and so is each coordinate; the world's own double rounding is nothing beside it.
    const auto positions = std::span(scene_.soup.positions).subspan(first_position);
    const glm::dvec3 origin(placed.to_world[3]);
    double distance = 0;
    for (const glm::dvec3& p : positions) distance = std::max(distance, glm::distance(p, origin));
    const double rounding = distance * static_cast<double>(std::numeric_limits<float>::epsilon());
    std::vector<mesh::Triangle> body;
    for (const mesh::Triangle& t : std::span(scene_.soup.triangles).subspan(first_triangle)) {
      const auto first = static_cast<std::uint32_t>(first_position);
      body.push_back({t[0] - first, t[1] - first, t[2] - first});
    }
    const FlatLight shape = recognise_flat_light(positions, body, rounding);
    if (const auto* why_not = std::get_if<std::string>(&shape)) {
      scene_.warnings.push_back(fmt::format(
          "'{}' is emissive, but no area light, because {}; it is rendered as plain geometry", look.name, *why_not));
      refused_lights_ += fmt::format("{}'{}' ({})", refused_lights_.empty() ? "" : ", ", look.name, *why_not);
      return std::nullopt;
    }
    AreaLight light;
    light.name = unique_name(light_names_, look.name);
    if (const auto* rectangle = std::get_if<Rectangle>(&shape))
      light.shape = *rectangle;
    else
      light.shape = std::get<Polygon>(shape);
    light.radiance = radiance;
    light.two_sided = material.doubleSided;
    scene_.lights.push_back(std::move(light));
    return static_cast<std::uint32_t>(scene_.lights.size() - 1);
  }

  void add_lamp(const tinygltf::Node& node, const PlacedNode& placed, const std::string& name) {
    AreaLight light = lamps_.light_of(node, placed);
    if (light.radiance == glm::dvec3(0)) return;  // off
    light.name = unique_name(light_names_, name);
    scene_.lights.push_back(std::move(light));
  }

  void add_camera(const tinygltf::Node& node, const PlacedNode& placed, const std::string& name) {
    if (static_cast<std::size_t>(node.camera) >= model_.cameras.size()) {
      throw InputError("/nodes/{}/camera: camera {} does not exist; there are {}", placed.number, node.camera,
                       model_.cameras.size());
    }
    const tinygltf::Camera& source = model_.cameras[static_cast<std::size_t>(node.camera)];
    if (source.type != "perspective") {
      ++other_cameras_;
      return;
    }
    const double angle = source.perspective.yfov;
    if (!(angle > 0 && angle < glm::radians(180.0))) {
      throw InputError("/cameras/{}/perspective/yfov: {}; expected more than 0 and less than pi", node.camera, angle);
    }
    // A camera looks along −Z of its node, with +Y up (glTF 2.0, 3.10).
    const glm::dvec3 forward(placed.to_world * glm::dvec4(0, 0, -1, 0)), up(placed.to_world * glm::dvec4(0, 1, 0, 0));
    if (!(glm::length(glm::cross(forward, up)) > 0)) {
      throw InputError("/nodes/{}: its transform squashes the camera flat", placed.number);
    }
    Camera camera;
    camera.name = unique_name(camera_names_, name);
    camera.eye = glm::dvec3(placed.to_world[3]);
    camera.target = camera.eye + glm::normalize(forward);
    camera.up = glm::normalize(up);
    camera.vertical_fov = glm::degrees(angle);
    scene_.cameras.push_back(std::move(camera));
  }

  /// From above the front right, at the distance at which the bounding sphere just fits into the picture.
  void add_camera_that_sees_all() {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (const glm::dvec3& p : scene_.soup.positions) low = glm::min(low, p), high = glm::max(high, p);
    Camera camera;
    camera.name = "synthesised";
    camera.target = (low + high) / 2.0;
    const double radius = glm::distance(low, high) / 2;
    const double distance =
        std::max(radius, std::numeric_limits<float>::min() * 1.0) / std::sin(glm::radians(camera.vertical_fov) / 2);
    camera.eye = camera.target + distance * glm::normalize(glm::dvec3(0.5, 0.5, 1));
    scene_.cameras.push_back(camera);
    scene_.warnings.emplace_back(
        "there is no perspective camera in the file; one that sees the whole scene was put in");
  }

  void add_warnings() {
    const auto count = [&](std::uint64_t number, const char* what) {
      if (number > 0) scene_.warnings.push_back(fmt::format("{} {}", number, what));
    };
    if (purpose_ != Purpose::mesh) lamps_.add_warnings(scene_.warnings);
    count(other_cameras_, "orthographic cameras ignored");
    count(points_and_lines_, "primitives of points or lines skipped");
    count(without_positions_, "primitives without POSITION skipped");
    count(without_triangles_, "primitives with fewer than three vertices skipped");
    count(leftover_indices_, "indices at the end of primitives skipped: they make no whole triangle");
    count(skinned_, "skinned meshes shown as modelled: skins are not supported");
    count(morphed_, "primitives shown without their morph targets");
    count(model_.animations.size(), "animations ignored");
    count(emissive_, "emissive objects are no lights here: those are the scene's");
    if (purpose_ != Purpose::mesh)
      count(textured_, "objects shown in their base colour factor: textures are not supported");
    count(emissive_textures_, "emissive textures ignored: these lights shine evenly");
    constexpr std::array<std::string_view, 3> kUnderstood{"KHR_materials_emissive_strength", "KHR_lights_punctual",
                                                          "KHR_mesh_quantization"};
    for (const std::string& extension : model_.extensionsUsed) {
      if (std::ranges::find(kUnderstood, extension) == kUnderstood.end()) {
        scene_.warnings.push_back(fmt::format("extension {} ignored", extension));
      }
    }
  }

  const tinygltf::Model& model_;
  Purpose purpose_;
  Scene scene_;
  PunctualLights lamps_;
  std::set<std::string> object_names_, camera_names_, light_names_;
  std::string refused_lights_;
  std::uint64_t other_cameras_ = 0, points_and_lines_ = 0, without_positions_ = 0, without_triangles_ = 0,
                leftover_indices_ = 0, skinned_ = 0, morphed_ = 0, textured_ = 0, emissive_textures_ = 0, emissive_ = 0;
};

Scene import_for(Purpose purpose, const mesh::InputFile& input, const ReadOptions& options) {
  tinygltf::Model model;
  load_gltf_model(input, options.allow_outside, model);
  try {
    return GltfImport(model, input.name.filename().string(), purpose, options).run();
  } catch (const InputError& error) {
    throw InputError("{}: {}", input.name.string(), error.what());  // places alone do not say in which file
  }
}

}  // namespace

Scene import_gltf(const mesh::InputFile& input, const ReadOptions& options) {
  return import_for(options.needs_light ? Purpose::lit_scene : Purpose::any_scene, input, options);
}

mesh::ImportedMesh import_gltf_mesh(const mesh::InputFile& input, bool allow_outside) {
  Scene scene = import_for(Purpose::mesh, input, {.allow_outside = allow_outside});
  mesh::ImportedMesh mesh{std::move(scene.soup), std::move(scene.warnings), {}};
  // One object, whose faces are numbered through.
  std::uint32_t number = 0;
  for (std::uint32_t& face : mesh.soup.source_face) face = number++;
  std::ranges::fill(mesh.soup.object, 0u);
  return mesh;
}

bool is_gltf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension == ".gltf" || extension == ".glb";
}

}  // namespace penumbra::scenes
