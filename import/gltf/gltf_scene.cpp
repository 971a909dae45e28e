// SPDX-License-Identifier: Apache-2.0
// Builds a scene from a parsed glTF model: nodes, meshes, materials, lamps and emissive meshes.

#include "import/gltf/gltf_scene.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "import/gltf/area_lamp.hpp"
#include "import/gltf/dome_extras.hpp"
#include "import/gltf/gltf_camera.hpp"
#include "import/gltf/gltf_deform.hpp"
#include "import/gltf/gltf_emission.hpp"
#include "import/gltf/gltf_extensions.hpp"
#include "import/gltf/gltf_extras.hpp"
#include "import/gltf/gltf_hidden.hpp"
#include "import/gltf/gltf_instances.hpp"
#include "import/gltf/gltf_nodes.hpp"
#include "import/gltf/gltf_primitive.hpp"
#include "import/gltf/gltf_shared.hpp"
#include "import/gltf/gltf_surface.hpp"
#include "import/gltf/gltf_triangles.hpp"
#include "import/gltf/punctual_lights.hpp"
#include "scenes/unique_names.hpp"

#include <tiny_gltf.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace penumbra::import {
namespace {

/// Returns whether a diffuse picture may change with the property at this JSON pointer. Metalness, gloss and relief of
/// materials do not matter, nor do clipping distances of cameras.
bool changes_light(std::string_view pointer) {
  constexpr std::array<std::string_view, 12> kOthers{"metallicFactor",
                                                     "roughnessFactor",
                                                     "/normalTexture",
                                                     "/occlusionTexture",
                                                     "/metallicRoughnessTexture",
                                                     "/KHR_materials_clearcoat",
                                                     "/KHR_materials_specular",
                                                     "/KHR_materials_sheen",
                                                     "/KHR_materials_ior",
                                                     "/KHR_materials_iridescence",
                                                     "/znear",
                                                     "/zfar"};
  return std::ranges::none_of(kOthers,
                              [&](std::string_view part) { return pointer.find(part) != std::string_view::npos; });
}

/// Builds the scene from a parsed model, node by node.
class GltfScene {
 public:
  /// `model` and the objects that `request` refers to must outlive this object.
  GltfScene(const tinygltf::Model& model, const SceneRequest& request, Purpose purpose)
      : model_(model),
        purpose_(purpose),
        needs_surface_(request.options.needs_surface),
        lenient_(request.options.lenient || purpose == Purpose::any_scene || purpose == Purpose::rest),
        unhidden_(request.unhidden),
        lamps_(model, request.options, losses_),
        surfaces_(model, scene_.pictures, losses_) {
    scene_.name = request.name;
    if (purpose != Purpose::mesh) instances_ = request.options.instances;
    scenes::LightmapPlaces* const lightmap = request.options.lightmap;
    if (lightmap == nullptr || purpose == Purpose::rest || purpose == Purpose::mesh) return;
    lightmap->places.clear();
    lightmap_ = &lightmap->places;
    surfaces_.read_lightmap(lightmap->set);
  }

  /// Reports the parts that parsing left out.
  void say_of(const TakenOut& taken_out, std::span<const std::size_t> played) {
    compressed_ = taken_out.compressed;
    for (const std::string& place : compressed_)
      losses_.refuse("is compressed with KHR_draco_mesh_compression, and left out", place);
    for (const auto& [target, clip] : taken_out.pointers) {
      const std::string what =
          "is animated by KHR_animation_pointer, which is not supported here: it keeps the value in the file";
      const bool moves = std::ranges::find(played, clip) != played.end() && changes_light(target);
      moves ? losses_.refuse(what, target) : losses_.mention(what, target);
    }
    scenes::Losses overruled;
    for (const std::string& node : taken_out.overruled)
      overruled.mention("has a matrix together with translation, rotation or scale, of which only the matrix is used",
                        node);
    overruled.warn(scene_.warnings);
    if (taken_out.no_utf8)
      scene_.warnings.emplace_back("some names are no UTF-8; their letters are shown as escapes such as \\xe9");
    if (taken_out.channels_without_node > 0) {
      scene_.warnings.push_back(
          fmt::format("{} animation channels name no node and are ignored", taken_out.channels_without_node));
    }
  }

  /// Returns whether some of the file's vertices are not in the scene; valid after the run.
  [[nodiscard]] bool left_vertices_out() const { return left_out_; }
  /// Returns the centre of the bounds of all vertices of the model's meshes, visible or not; valid after a run with
  /// Purpose::rest.
  [[nodiscard]] glm::dvec3 middle() const { return 0.5 * lower_ + 0.5 * upper_; }

  scenes::Scene run() {
    const std::vector<PlacedNode> nodes = place_nodes(model_, scene_.warnings);
    to_world_.resize(model_.nodes.size());
    for (const PlacedNode& placed : nodes) to_world_[static_cast<std::size_t>(placed.number)] = placed.to_world;
    if (instances_ != nullptr) purpose_ == Purpose::rest ? shared_.measure(nodes) : shared_.keep_in(*instances_, nodes);
    for (const PlacedNode& placed : nodes) add_node(placed);
    for (const std::size_t light : shadeless_) {
      scene_.lights[light].unshaded_by.resize(scene_.objects.size());
      std::iota(scene_.lights[light].unshaded_by.begin(), scene_.lights[light].unshaded_by.end(), 0U);
    }
    const bool is_empty = scene_.soup.triangles.empty() && !shared_.any();
    if (is_empty && !compressed_.empty()) {
      throw InputError(
          "{}: its vertices are compressed with KHR_draco_mesh_compression, which is not supported; "
          "export without compression",
          compressed_.front());
    }
    if (is_empty && needs_surface_) {
      throw InputError(
          "there are no triangles in the scene ({} primitives of points or lines, {} without POSITION, {} with "
          "fewer than three vertices)",
          skipped_.points_and_lines, skipped_.without_positions, skipped_.without_triangles);
    }
    if (scene_.lights.empty() && purpose_ == Purpose::lit_scene && !refused_lights_.empty() && !lenient_) {
      throw InputError(
          "there is no light in the scene: none could be made of {}. In Blender, add a plane, turn its front to the "
          "scene and give it a material with emission (Emission Strength above 0), or add a point, spot or sun lamp "
          "and "
          "export with Punctual Lights (area lamps are lost in glTF); with --lenient a studio's light takes their "
          "place",
          refused_lights_);
    }
    count_what_came(nodes);
    complete_looks(scene_);
    if (lightmap_ != nullptr) lightmap_->resize(scene_.soup.positions.size(), mesh::kNoPlace);
    judge_extensions(model_, is_mesh(), losses_, scene_.warnings);
    add_warnings();
    if (!lenient_) losses_.throw_refused();
    is_mesh() ? losses_.warn_of_refused(scene_.warnings) : losses_.warn(scene_.warnings);
    return std::move(scene_);
  }

 private:
  [[nodiscard]] bool is_mesh() const { return purpose_ == Purpose::mesh || purpose_ == Purpose::rest; }

  [[nodiscard]] PlacedNode unhidden(const PlacedNode& placed) const {
    const auto number = static_cast<std::size_t>(placed.number);
    return number < unhidden_.size() && unhidden_[number] ? PlacedNode{placed.number, *unhidden_[number]} : placed;
  }

  /// Returns the place of a lamp: the node's position and direction, regardless of its scale.
  [[nodiscard]] PlacedNode lamp_place(const PlacedNode& placed) const {
    PlacedNode place = unhidden(placed);
    place.to_world[3] = placed.to_world[3];
    return place;
  }

  /// Checks that every primitive of every instance in the scene was read, or was counted as one without triangles.
  void count_what_came(std::span<const PlacedNode> nodes) const {
    std::uint64_t there = 0;
    for (const PlacedNode& placed : nodes) {
      const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(placed.number)];
      if (!placed.visible || node.mesh < 0) continue;
      const auto instances = instances_of(model_, node, placed.number);
      there +=
          (instances ? instances->size() : 1) * model_.meshes[static_cast<std::size_t>(node.mesh)].primitives.size();
    }
    const std::uint64_t came = scene_.objects.size() + gone_ + bodiless_ + skipped_.points_and_lines +
                               skipped_.without_positions + skipped_.without_triangles;
    PENUMBRA_ASSERT(there == came, "of {} primitives in the scene {} were read", there, came);
  }

  void add_node(const PlacedNode& placed) {
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(placed.number)];
    const std::string name = node.name.empty() ? fmt::format("node {}", placed.number) : node.name;
    if (!is_mesh() && node.camera >= 0) add_camera(node, placed, name);
    if (!placed.visible) return;
    if (node.mesh >= 0) add_meshes(node, placed, name);
    if (is_mesh()) {
      lamps_left_ += (node.camera >= 0 ? 1U : 0U) + (node.extensions.contains("KHR_lights_punctual") ? 1U : 0U);
      return;
    }
    if (node.extensions.contains("KHR_lights_punctual")) {
      if (const auto lamp = lamps_.light_of(node, lamp_place(placed), name))
        add_lamp(*lamp, node, name);
      else
        note_refused_light(name, "a lamp of a type that KHR_lights_punctual does not have");
    }
    if (const auto lamp = area_lamp_of(node, placed, losses_)) add_lamp(*lamp, node, name);
    if (const auto dome = dome_of(node, placed, losses_)) add_lamp(*dome, node, name);
  }

  void add_meshes(const tinygltf::Node& node, const PlacedNode& placed, const std::string& name) {
    const auto instances = instances_of(model_, node, placed.number);
    if (!instances) return add_mesh_or_hidden(node, placed, name);
    if (node.skin >= 0) losses_.mention("has instances of a skinned mesh, all of which are where its joints are", name);
    if (instances->empty())
      losses_.mention("has an empty list of instances (EXT_mesh_gpu_instancing), so it is not shown", name);
    for (std::size_t i = 0; i < instances->size(); ++i)
      add_mesh(node, {placed.number, placed.to_world * (*instances)[i]}, fmt::format("{}.{}", name, i));
  }

  /// Adds a mesh. A light that is scaled to zero stays a dark light with its unscaled shape, so that all frames have
  /// the same lights. Its visible surface stays where its transform puts it.
  void add_mesh_or_hidden(const tinygltf::Node& node, const PlacedNode& placed, const std::string& name) {
    const PlacedNode whole = unhidden(placed);
    const auto hidden_at = is_mesh() ? std::nullopt : hidden_light(model_, placed.number, to_world_, unhidden_);
    if (!hidden_at) return add_mesh(node, placed, name);
    const std::size_t first_position = scene_.soup.positions.size(), first_light = scene_.lights.size();
    const std::vector<std::optional<glm::dmat4>> posed = std::exchange(to_world_, {unhidden_.begin(), unhidden_.end()});
    add_mesh(node, whole, name);
    to_world_ = posed;
    const glm::dmat4 back = glm::inverse(whole.to_world);
    for (glm::dvec3& p : std::span(scene_.soup.positions).subspan(first_position))
      p = node.skin >= 0 ? *hidden_at : glm::dvec3(placed.to_world * (back * glm::dvec4(p, 1)));
    for (scenes::AreaLight& light : std::span(scene_.lights).subspan(first_light)) {
      light.radiance = glm::dvec3(0);
      losses_.mention("is scaled to zero: its light is dark", light.name);
    }
  }

  void add_mesh(const tinygltf::Node& node, const PlacedNode& placed, const std::string& name) {
    if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) {
      throw InputError("/nodes/{}/mesh: mesh {} does not exist; there are {}", placed.number, node.mesh,
                       model_.meshes.size());
    }
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    flags_ = flags_of(node, mesh, losses_);
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const std::string own_name = mesh.primitives.size() > 1 ? fmt::format("{}/{}", name, i) : name;
      if (const SharedPrimitives::Primitive* const known = shared_.find({node.mesh, i}, node))
        add_instance(*known, placed, object_names_.take(own_name));
      else
        add_primitive(mesh.primitives[i], node, placed, {node.mesh, i}, own_name);
    }
  }

  void add_instance(const SharedPrimitives::Primitive& shared, const PlacedNode& placed, const std::string& name) {
    shared_.place(shared, placed, scene_.objects.size(), scene_.soup.triangles.size());
    add_named(shared.object, name);
    bound(shared.local, placed);
  }
  void add_named(scenes::Object object, const std::string& name) {
    object.name = name;
    object.casts_shadow = flags_.casts_shadow;
    object.receives_shadow = flags_.receives_shadow;
    scene_.objects.push_back(std::move(object));
  }

  void add_primitive(const tinygltf::Primitive& primitive, const tinygltf::Node& node, const PlacedNode& placed,
                     const SharedPrimitives::Number& number, const std::string& name) {
    const std::string place = fmt::format("/meshes/{}/primitives/{}", number.first, number.second);
    std::optional<PrimitiveMesh> mesh = read_primitive(model_, primitive, place, skipped_);
    if (!mesh) return;
    std::vector<glm::dvec3>& positions = mesh->positions;
    std::optional<Skinned> skinned;
    if (purpose_ != Purpose::rest) {
      morph(model_, node, primitive, "POSITION", place, positions);
      skinned = skin(model_, {node, placed.to_world}, primitive, place, to_world_);
      if (skinned && skinned->vertices.size() != positions.size()) {
        throw InputError("{}/attributes/JOINTS_0: joints of {} vertices; there are {}", place, skinned->vertices.size(),
                         positions.size());
      }
    }
    const std::string own_name = object_names_.take(name);
    if (skinned && skinned->without_weights > 0)
      losses_.mention("has vertices that no joint moves; they move with their node", own_name);
    Look look = surfaces_.read(primitive, place, own_name, positions.size());
    if (purpose_ != Purpose::rest) morph(model_, node, primitive, "NORMAL", place, look.normals);
    switch (surfaces_.opacity_of(look)) {
      case Opacity::gone:
        losses_.mention("is wholly transparent, and left out", own_name);
        left_out_ = true;
        ++gone_;
        bound(positions, placed);
        return;
      case Opacity::solid:
        look.alpha = {};
        break;
      case Opacity::neither:
        if (is_mesh())
          losses_.refuse("becomes solid as a mesh of another scene: its alpha is supported only in glTF scenes",
                         own_name);
        break;
    }
    const PrimitiveVertices vertices{positions, skinned, look, placed, place, lightmap_};
    if (!shared_.may_share(primitive, node, look)) return add_object(vertices, std::move(mesh->triangles), own_name);
    scenes::SharedMesh shared = shared_mesh(vertices, std::move(mesh->triangles));
    left_out_ |= shared.soup.positions.size() < positions.size();
    add_instance(shared_.add(number, std::move(shared), object_of(look), positions), placed, own_name);
  }

  void bound(std::span<const glm::dvec3> positions, const PlacedNode& placed) {
    if (purpose_ != Purpose::rest) return;
    for (const glm::dvec3& position : positions) {
      const glm::dvec3 p(placed.to_world * glm::dvec4(position, 1));
      // a position that no triangle uses
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
      lower_ = glm::min(lower_, p);
      upper_ = glm::max(upper_, p);
    }
  }

  static scenes::Object object_of(const Look& look) {
    scenes::Object object;
    object.color = look.color;
    object.material = look.material;
    object.picture = look.picture;
    object.alpha = look.alpha;
    return object;
  }

  void add_object(const PrimitiveVertices& vertices, std::vector<mesh::Triangle> triangles, const std::string& name) {
    const Look& look = vertices.look;
    const bool pictured = look.emission && !is_mesh();  // a mesh without lights has no emission
    using Mode = scenes::Alpha::Mode;
    const bool lets_through = look.alpha.mode != Mode::opaque;
    const bool evenly = look.alpha.mode == Mode::blend && !look.picture && look.colors.empty();
    const glm::dvec3 radiance = (pictured ? radiance_of(vertices, triangles, means_) : look.radiance) *
                                (evenly ? look.alpha.factor : 1.0);  // emission scales with coverage
    if (pictured && radiance != glm::dvec3(0))
      losses_.mention("emits uniformly, with the mean of its emissive picture over its surface", name);
    else if (pictured)
      note_refused_light(name, "its emissive picture is black on its surface");
    if (look.picture || !look.normals.empty() || !look.colors.empty() || look.color != glm::dvec3(1)) ++looks_left_;
    const SoupEnd before = append_triangles(scene_, vertices, std::move(triangles));
    scenes::Object object = object_of(look);
    object.emits = add_light({radiance, vertices.look.two_sided}, name, vertices.placed, before);
    if (object.emits && lets_through && !evenly)
      losses_.refuse(
          "is emissive and lets light through in places (alphaMode MASK or BLEND); lights shine evenly: make it "
          "opaque, or cut the mesh to the part that shines",
          name);
    if (object.emits && !flags_.body) {  // the object only marks the place of the light
      ++bodiless_;
      return shorten(scene_, before);
    }
    left_out_ |= scene_.soup.positions.size() - before.position < vertices.local.size();
    bound(vertices.local, vertices.placed);
    add_named(std::move(object), name);
  }

  void note_refused_light(const std::string& name, const std::string& why_not) {
    refused_lights_ += fmt::format("{}'{}' ({})", refused_lights_.empty() ? "" : ", ", name, why_not);
  }

  struct Emission {
    glm::dvec3 radiance;
    bool two_sided;
  };
  /// Returns the index of the light whose body is the triangles since `before`, if they form one.
  std::optional<std::uint32_t> add_light(const Emission& emission, const std::string& name, const PlacedNode& placed,
                                         const SoupEnd& before) {
    const glm::dvec3& radiance = emission.radiance;
    if (!(radiance.x > 0 || radiance.y > 0 || radiance.z > 0)) return std::nullopt;
    if (purpose_ == Purpose::mesh) {
      ++emissive_;
      return std::nullopt;
    }
    auto recognised = emitter_since(scene_, before, placed, emission.two_sided);
    if (const auto* why_not = std::get_if<std::string>(&recognised)) {
      losses_.refuse(fmt::format("is emissive, but no area light, because {}; it would be plain geometry", *why_not),
                     name);
      note_refused_light(name, *why_not);
      return std::nullopt;
    }
    auto& emitter = std::get<Emitter>(recognised);
    if (emitter.hides_itself) losses_.refuse(kHidesItself, name);
    scene_.lights.push_back({.name = light_names_.take(flags_.light_name.empty() ? name : flags_.light_name),
                             .shape = std::move(emitter.shape),
                             .radiance = radiance,
                             .two_sided = emitter.two_sided});
    return static_cast<std::uint32_t>(scene_.lights.size() - 1);
  }

  void add_lamp(scenes::AreaLight light, const tinygltf::Node& node, const std::string& name) {
    if (light.radiance == glm::dvec3(0)) return;  // the lamp is off
    light.name = light_names_.take(name);
    if (!lamp_casts_shadows(node, losses_)) shadeless_.push_back(scene_.lights.size());
    scene_.lights.push_back(std::move(light));
  }

  void add_camera(const tinygltf::Node& node, const PlacedNode& placed, const std::string& name) {
    scenes::Camera camera = camera_of(model_, node, placed, losses_);
    camera.name = camera_names_.take(name);
    scene_.cameras.push_back(std::move(camera));
  }

  void add_warnings() {
    const auto count = [&](std::uint64_t number, const char* what) {
      if (number > 0) scene_.warnings.push_back(fmt::format("{} {}", number, what));
    };
    if (!is_mesh()) lamps_.add_warnings(scene_.warnings);
    count(skipped_.points_and_lines, "primitives of points or lines skipped");
    count(skipped_.without_positions, "primitives without POSITION skipped");
    count(skipped_.without_triangles, "primitives with fewer than three vertices skipped");
    count(skipped_.leftover_indices, "indices at the end of primitives skipped: they make no whole triangle");
    count(emissive_, "emissive objects are not lights here: lights come from the scene");
    if (purpose_ == Purpose::mesh) {
      count(looks_left_,
            "objects lose their pictures, colours and normals: a mesh of another scene has the colour that is "
            "said there");
      count(lamps_left_, "lamps and cameras left out: these come from the scene");
    }
  }

  const tinygltf::Model& model_;
  Purpose purpose_;
  bool needs_surface_, lenient_;
  std::span<const std::optional<glm::dmat4>> unhidden_;  // empty, or one for each node
  scenes::Scene scene_;
  std::vector<std::optional<glm::dmat4>> to_world_;  // for each node; nullopt for nodes outside of the scene
  scenes::Losses losses_;
  PunctualLights lamps_;
  SurfaceReader surfaces_;
  std::vector<glm::dvec2>* lightmap_ = nullptr;
  scenes::Instances* instances_ = nullptr;  // null: each instance is a copy
  SharedPrimitives shared_{model_};
  PictureMeans means_{scene_.pictures};
  scenes::UniqueNames object_names_, camera_names_, light_names_;
  std::string refused_lights_;
  SkippedPrimitives skipped_;
  std::vector<std::string> compressed_;    // primitives that were left out
  std::uint64_t gone_ = 0, bodiless_ = 0;  // primitives that are completely transparent; primitives that only mark the
                                           // place of a light
  bool left_out_ = false;
  glm::dvec3 lower_{std::numeric_limits<double>::infinity()}, upper_{-std::numeric_limits<double>::infinity()};
  ObjectFlags flags_;                                             // flags of the current mesh
  std::vector<std::size_t> shadeless_;                            // lights that cast no shadows
  std::uint64_t emissive_ = 0, looks_left_ = 0, lamps_left_ = 0;  // counts for Purpose::mesh
};

}  // namespace

BuiltScene build_scene(const tinygltf::Model& model, const SceneRequest& request, Purpose purpose,
                       const TakenOut& taken_out) {
  GltfScene builder(model, request, purpose);
  builder.say_of(taken_out, request.played);
  BuiltScene built;
  built.scene = builder.run();
  built.left_vertices_out = builder.left_vertices_out();
  return built;
}

glm::dvec3 middle_at_rest(const tinygltf::Model& model, const SceneRequest& request) {
  GltfScene rest(model, request, Purpose::rest);
  rest.run();
  return rest.middle();
}

}  // namespace penumbra::import
