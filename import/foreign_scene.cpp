// SPDX-License-Identifier: Apache-2.0
// Converts the lamps, cameras and colours that Assimp found in FBX and COLLADA files to the program's own. Blender's
// exporters write the power of a lamp in watts where others write candela.

#include "import/foreign_scene.hpp"

#include "base/error.hpp"
#include "import/gltf/emitters/emitter.hpp"
#include "import/read.hpp"
#include "import/scene_parts.hpp"
#include "import/text.hpp"
#include "scenes/losses.hpp"
#include "scenes/unique_names.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

namespace penumbra::import {
namespace {

class ForeignScene {
 public:
  /// `options` must outlive this object.
  ForeignScene(mesh::ImportedMesh mesh, SceneParts parts, const scenes::ReadOptions& options, bool is_fbx)
      : parts_(std::move(parts)),
        options_(options),
        is_fbx_(is_fbx),
        from_blender_(parts_.generator.starts_with("Blender")) {
    scene_.soup = std::move(mesh.soup);
    scene_.warnings = std::move(mesh.notes);
    if (std::ranges::any_of(parts_.normals, [](const glm::vec3& n) { return n != glm::vec3(0); }))
      scene_.looks.normals = std::move(parts_.normals);
  }

  scenes::Scene run(const std::string& name) {
    scene_.name = name;
    for (std::size_t i = 0; i < parts_.parts.size(); ++i) {
      const std::size_t end =
          i + 1 < parts_.parts.size() ? parts_.parts[i + 1].first_triangle : scene_.soup.triangles.size();
      if (parts_.parts[i].first_triangle < end) add_object(parts_.parts[i], end);
    }
    for (const SceneParts::Lamp& lamp : parts_.lamps) add_lamp(lamp);
    for (const SceneParts::Lens& lens : parts_.lenses) add_camera(lens);
    if (parts_.has_orthographic)
      losses_.refuse("has an orthographic camera, which would become a perspective camera (export glTF)", name);
    if (parts_.moves) scene_.warnings.emplace_back("the file is read at rest; its animation is ignored (export glTF)");
    if (lamps_ > 0) {
      scene_.warnings.push_back(fmt::format(
          "{} lamps have no size in such files: taken as spheres of radius {} (--lamp-radius) and suns of {} degrees "
          "(--sun-angle), as bright as {}",
          lamps_, options_.lamp_radius.value_or(scenes::kLampRadius), options_.sun_angle.value_or(scenes::kSunAngle),
          from_blender_ ? "in Blender" : "if their intensities were candela and lux"));
    }
    // A file without a light gets a studio, which shows only its shapes. Losses are then reported and not refused,
    // because the file has no lighting of its own that they could make wrong.
    if (!options_.lenient && options_.needs_light && !scene_.lights.empty()) losses_.throw_refused();
    losses_.warn(scene_.warnings);
    return std::move(scene_);
  }

 private:
  void add_object(const SceneParts::Part& part, std::size_t end) {
    scenes::Object object;
    object.name = objects_.take(part.name.empty() ? "mesh" : part.name);
    object.color = glm::clamp(part.color, 0.0, 1.0);
    object.material = part.material;
    if (part.has_picture) {
      losses_.mention("has a colour image, which is left out and replaced by white (export glTF)", object.name);
      object.color = glm::dvec3(1);
    }
    if (part.opacity < 1 || part.has_cut)
      losses_.refuse("lets light through, which is not supported for such files: it would be solid (export glTF)",
                     object.name);
    std::fill(scene_.soup.object.begin() + static_cast<std::ptrdiff_t>(part.first_triangle),
              scene_.soup.object.begin() + static_cast<std::ptrdiff_t>(end),
              static_cast<std::uint32_t>(scene_.objects.size()));
    object.emits = add_emitter(part, end, object.name);
    scene_.objects.push_back(std::move(object));
  }

  std::optional<std::uint32_t> add_emitter(const SceneParts::Part& part, std::size_t end, const std::string& name) {
    const glm::dvec3& radiance = part.emission;
    if (!(std::max({radiance.x, radiance.y, radiance.z}) > 0)) return std::nullopt;
    std::map<std::uint32_t, std::uint32_t> number_of;
    std::vector<glm::dvec3> positions;
    std::vector<mesh::Triangle> body;
    double farthest = 0;
    for (std::size_t i = part.first_triangle; i < end; ++i) {
      mesh::Triangle own{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = scene_.soup.triangles[i][k];
        const auto [at, is_new] = number_of.emplace(vertex, static_cast<std::uint32_t>(positions.size()));
        if (is_new) positions.push_back(scene_.soup.positions[vertex]);
        own[k] = at->second;
        farthest = std::max(farthest, glm::length(positions[own[k]]));
      }
      body.push_back(own);
    }
    // Assimp has positions and transforms in single precision.
    const double rounding = 4 * farthest * static_cast<double>(std::numeric_limits<float>::epsilon());
    auto found = recognise_emitter(positions, body, true, rounding);
    if (const auto* why_not = std::get_if<std::string>(&found)) {
      losses_.refuse(fmt::format("is emissive, but no area light, because {}; it would be plain geometry", *why_not),
                     name);
      return std::nullopt;
    }
    auto& emitter = std::get<Emitter>(found);
    if (emitter.hides_itself) losses_.refuse(kHidesItself, name);
    scene_.lights.push_back({.name = lights_.take(name),
                             .shape = std::move(emitter.shape),
                             .radiance = radiance,
                             .two_sided = emitter.two_sided});
    return static_cast<std::uint32_t>(scene_.lights.size() - 1);
  }

  void add_lamp(const SceneParts::Lamp& lamp) {
    using Kind = SceneParts::Lamp::Kind;
    if (lamp.kind == Kind::other)
      return losses_.refuse(
          "is an area lamp, or one that these files do not describe; make it an emissive plane, or export glTF",
          lamp.name);
    glm::dvec3 color = lamp.color;
    if (from_blender_ && parts_.white_is_grey && color.x == color.y && color.y == color.z) color /= 0.8;
    if (color == glm::dvec3(0)) return;
    if (std::min({color.x, color.y, color.z}) < 0)
      return losses_.refuse("is a lamp with a negative intensity", lamp.name);
    scenes::AreaLight light;
    if (lamp.kind != Kind::point && !(glm::length(lamp.direction) > 0))
      return losses_.refuse("is a lamp whose transform leaves it no direction", lamp.name);
    if (lamp.kind == Kind::sun) {
      const scenes::Sun sun{glm::normalize(lamp.direction), options_.sun_angle.value_or(scenes::kSunAngle)};
      light.shape = sun;
      light.radiance = color / (sun.angle > 0 ? scenes::irradiance_of_radiance(sun) : 1.0);
    } else {
      scenes::Sphere sphere{lamp.position, std::max(options_.lamp_radius.value_or(scenes::kLampRadius), 1e-4), {}};
      if (lamp.kind == Kind::spot) sphere.cone = cone_of(lamp);
      const double candela = from_blender_ ? 1 / (4 * std::numbers::pi) : 1;  // candela for each watt
      light.radiance = candela / (std::numbers::pi * sphere.radius * sphere.radius) * color;
      light.shape = sphere;
    }
    ++lamps_;
    light.name = lights_.take(lamp.name);
    scene_.lights.push_back(std::move(light));
  }

  /// Blender writes spots with an inner angle of (1 − blend) of the angle; their light falls off over `blend` of the
  /// cosines.
  [[nodiscard]] scenes::Cone cone_of(const SceneParts::Lamp& lamp) {
    const glm::dvec3 direction = glm::normalize(lamp.direction);
    const double quarter = std::numbers::pi / 2;
    if (!is_fbx_) {  // COLLADA has one angle, and an exponent in place of a second
      losses_.mention("is a spot lamp, which gets a hard edge: such files do not describe its falloff", lamp.name);
      const double angle = glm::degrees(std::clamp(lamp.inner, 1e-3, quarter));
      return {direction, angle, angle, false};
    }
    const double outer = std::clamp(lamp.outer, 1e-3, quarter), inner = std::clamp(lamp.inner, 0.0, outer);
    if (!from_blender_) return {direction, glm::degrees(inner), glm::degrees(outer), false};
    const double full = std::cos(outer), edge = full + std::max((1 - full) * (1 - inner / outer), 0.001);
    return {direction, glm::degrees(std::acos(std::min(edge, 1.0))), glm::degrees(outer), true};
  }

  void add_camera(const SceneParts::Lens& lens) {
    if (!(glm::length(glm::cross(lens.forward, lens.up)) > 0) ||
        !(lens.horizontal_fov > 0 && lens.horizontal_fov < std::numbers::pi))
      return losses_.mention("is an invalid camera, and is left out", lens.name);
    scenes::Camera camera;
    camera.name = cameras_.take(lens.name);
    camera.eye = lens.eye;
    camera.target = lens.eye + glm::normalize(lens.forward);
    camera.up = glm::normalize(lens.up);
    const double aspect = lens.aspect > 0 && std::isfinite(lens.aspect) ? lens.aspect : 1;
    camera.vertical_fov = glm::degrees(2 * std::atan(std::tan(lens.horizontal_fov / 2) / aspect));
    camera.aspect = aspect;
    scene_.cameras.push_back(std::move(camera));
  }

  SceneParts parts_;
  const scenes::ReadOptions& options_;
  bool is_fbx_, from_blender_;
  scenes::Scene scene_;
  scenes::Losses losses_;
  scenes::UniqueNames objects_, lights_, cameras_;
  std::uint64_t lamps_ = 0;
};

}  // namespace

bool is_foreign_scene(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".fbx" || extension == ".dae";
}

scenes::Scene import_foreign_scene(const mesh::InputFile& input, const scenes::ReadOptions& options) {
  SceneParts parts;
  if (options.lightmap != nullptr) parts.uv = options.lightmap->set;
  mesh::ImportedMesh mesh = read_scene_parts(input, parts);
  if (options.lightmap != nullptr) options.lightmap->places = std::move(parts.places);
  const bool is_fbx = lower_extension(input.name) == ".fbx";
  try {
    return ForeignScene(std::move(mesh), std::move(parts), options, is_fbx).run(input.name.filename().string());
  } catch (const InputError& error) {
    throw InputError("{}: {}", input.name.string(), error.what());
  }
}

}  // namespace penumbra::import
