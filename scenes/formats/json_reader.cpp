// SPDX-License-Identifier: Apache-2.0
// Reads penumbra-scene/1: version first, then the schema, then cameras, lights and objects, whose names refer to one
// another.

#include "scenes/formats/json_reader.hpp"

#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/utf8.hpp"
#include "mesh/soup_memory.hpp"
#include "scenes/formats/checks.hpp"
#include "scenes/formats/json_document.hpp"
#include "scenes/formats/json_meshes.hpp"
#include "scenes/formats/json_schema.hpp"
#include "scenes/formats/lights/light_formats.hpp"
#include "scenes/light_kind.hpp"
#include "scenes/light_texture.hpp"

#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>

namespace penumbra::scenes {
namespace {

using nlohmann::json;

/// Names are written to line-based file formats and into channel names.
void check_name(const std::string& name, const Place& place) {
  const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == 127; };
  if (std::any_of(name.begin(), name.end(), is_control)) {
    throw InputError("{}: the name holds a control character; expected printable text", place.str());
  }
}

std::string read_name(const json& value, const Place& place, std::string fallback) {
  std::string name = value.value("name", std::move(fallback));
  check_name(name, place / "name");
  return name;
}

Camera read_camera(const json& value, const Place& place, std::string fallback_name) {
  Camera camera;
  camera.name = read_name(value, place, std::move(fallback_name));
  camera.eye = read_vector(value["eye"]);
  camera.target = read_vector(value["target"]);
  if (value.contains("up")) camera.up = read_vector(value["up"]);
  camera.vertical_fov = value.value("verticalFov", camera.vertical_fov);
  if (value.contains("orthographicHeight")) camera.height = value["orthographicHeight"].get<double>();
  if (value.contains("shift")) camera.shift = {value["shift"][0].get<double>(), value["shift"][1].get<double>()};
  if (value.contains("aperture")) {
    camera.lens = {value["aperture"].get<double>(),
                   value.value("focusDistance", glm::distance(camera.eye, camera.target))};
  } else if (value.contains("focusDistance")) {
    throw InputError(
        "{}: everything is sharp without an aperture; expected \"aperture\", the lens's radius, in the same camera",
        (place / "focusDistance").str());
  }
  check_camera(camera, place.str());
  return camera;
}

/// Reads the cameras. `--camera` selects by name, so a duplicate name gets a number.
std::vector<Camera> read_cameras(const json& document, const Place& root, std::vector<std::string>& warnings) {
  if (document.contains("camera")) return {read_camera(document["camera"], root / "camera", "camera")};
  std::vector<Camera> cameras;
  std::set<std::string> taken;
  for (const json& value : document["cameras"]) {
    const Place place = root / "cameras" / cameras.size();
    Camera camera = read_camera(value, place, fmt::format("camera{}", cameras.size()));
    const std::string name = camera.name;
    for (int number = 2; !taken.insert(camera.name).second; ++number) camera.name = fmt::format("{}_{}", name, number);
    if (camera.name != name) {
      warnings.push_back(
          fmt::format("{}: the name \"{}\" is taken; the camera is called \"{}\"", place.str(), name, camera.name));
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

Texture read_light_texture(const json& value, const Place& place, const ReadOptions& options, Scene& scene) {
  if (!value.contains("rectangle")) {
    throw InputError("{}: only a \"rectangle\" light can have a texture; remove it or make the light a rectangle",
                     place.str());
  }
  const std::string name = value["texture"].get<std::string>();
  const SceneFile file = open_scene_file(name, place, options);
  Texture texture = at_place(place, [&] { return read_texture(file.input, name, scene.warnings); });
  scene.sources.push_back(file.path);
  return texture;
}

/// Reads a sun's light, given by its radiance or by the irradiance of a surface facing it. A sun of angle 0 has no
/// radiance.
void read_sun_light(const json& value, const Place& place, AreaLight& light, Scene& scene) {
  const Sun& sun = std::get<Sun>(light.shape);
  if (value.contains("irradiance")) {
    light.radiance = read_vector(value["irradiance"]);
    if (sun.angle > 0) light.radiance /= irradiance_of_radiance(sun);
  } else if (sun.angle == 0 && value.contains("radiance")) {
    scene.warnings.push_back(
        fmt::format("{}: a sun of angle 0 is a point and has no radiance; taken as its irradiance (\"irradiance\")",
                    (place / "radiance").str()));
  }
}

AreaLight read_light(const json& value, const Place& place, std::string fallback_name, const ReadOptions& options,
                     Scene& scene) {
  AreaLight light;
  light.name = read_name(value, place, std::move(fallback_name));
  if (value.contains("radiance")) light.radiance = read_vector(value["radiance"]);
  light.two_sided = value.value("twoSided", false);
  light.visible = value.value("visible", false);
  light.shape = read_light_shape(value);
  const std::string where = (place / key_of(light.shape)).str();
  check_light(light, where);
  if (const auto hint = format_of(light.shape).hint) {
    if (const std::string text = hint(light.shape); !text.empty())
      scene.warnings.push_back(fmt::format("{}: {}", where, text));
  }
  if (std::holds_alternative<Sun>(light.shape)) read_sun_light(value, place, light, scene);
  if (value.contains("irradiance") && !value.contains("sun")) {
    throw InputError("{}: only a \"sun\" has an irradiance; expected \"radiance\"", (place / "irradiance").str());
  }
  const auto* const dome = std::get_if<Dome>(&light.shape);
  if (dome == nullptr && value.contains("visible"))
    throw InputError("{}: only a \"dome\" can be visible as the background", (place / "visible").str());
  if (dome != nullptr && !dome->image.empty())
    light.texture = read_sky(dome->image, place / "dome" / "image", options, scene);
  if (value.contains("texture")) light.texture = read_light_texture(value, place / "texture", options, scene);
  return light;
}

std::vector<AreaLight> read_lights(const json& document, const Place& root, const ReadOptions& options, Scene& scene) {
  std::vector<AreaLight> lights;
  std::unordered_map<std::string, std::size_t> number_of;  // index of each name
  for (const json& value : document["lights"]) {
    const Place place = root / "lights" / lights.size();
    AreaLight light = read_light(value, place, fmt::format("light{}", lights.size()), options, scene);
    const auto [same, is_new] = number_of.emplace(light.name, lights.size());
    if (!is_new) {
      throw InputError("{}: the name \"{}\" is that of light {} already; names of lights must differ", place.str(),
                       light.name, same->second);
    }
    lights.push_back(std::move(light));
  }
  return lights;
}

template <typename Named>
[[noreturn]] void throw_unknown(const char* what, const std::string& name, const Place& place,
                                const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) {
    if (std::ranges::find(names, one.name) == names.end()) names.push_back(one.name);
  }
  constexpr std::size_t kMost = 16;
  const std::string near = did_you_mean(name, names);
  const bool more = names.size() > kMost;
  if (more) names.resize(kMost);
  throw InputError("{}: no {} is named \"{}\"; there {}: {}{}{}", place.str(), what, name,
                   names.size() == 1 ? "is" : "are", fmt::join(names, ", "), more ? " and others" : "", near);
}

std::uint32_t named_light(const json& value, const Place& place, const std::vector<AreaLight>& lights) {
  const std::string name = value.get<std::string>();
  const auto found = std::ranges::find(lights, name, &AreaLight::name);
  if (found == lights.end()) throw_unknown("light", name, place, lights);
  return static_cast<std::uint32_t>(found - lights.begin());
}

/// Returns the number of the light whose body is the mesh.
std::uint32_t named_body(const json& value, const Place& place, const std::vector<AreaLight>& lights) {
  const std::uint32_t light = named_light(value, place, lights);
  const auto kind = kind_of(lights[light].shape);
  if (kind && traits_of(*kind).place == LightPlace::directions) {
    throw InputError("{}: the light \"{}\" is a {}, infinitely far away, so no mesh is its body; remove \"emits\"",
                     place.str(), lights[light].name, traits_of(*kind).name);
  }
  return light;
}

Object read_object(const json& value, const Place& place, const std::vector<AreaLight>& lights,
                   std::string fallback_name) {
  Object object;
  object.name = read_name(value, place, std::move(fallback_name));
  if (value.contains("color")) object.color = read_vector(value["color"]);
  object.casts_shadow = value.value("castsShadow", true);
  object.receives_shadow = value.value("receivesShadow", true);
  if (value.contains("emits")) object.emits = named_body(value["emits"], place / "emits", lights);
  if (value.contains("lights")) {
    std::set<std::uint32_t> lit_by;
    const json& names = value["lights"];
    for (std::size_t i = 0; i < names.size(); ++i) {
      lit_by.insert(named_light(names[i], place / "lights" / i, lights));
    }
    object.lit_by.emplace(lit_by.begin(), lit_by.end());
  }
  return object;
}

/// Returns the indices of all meshes with one of these names.
std::set<std::uint32_t> named_objects(const json& names, const Place& place, const std::vector<Object>& objects) {
  std::set<std::uint32_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = names[i].get<std::string>();
    bool any = false;
    for (std::uint32_t object = 0; object < objects.size(); ++object) {
      if (objects[object].name != name) continue;
      found.insert(object);
      any = true;
    }
    if (!any) throw_unknown("mesh", name, place / i, objects);
  }
  return found;
}

/// Reads the casters of each light: the included objects, or all if none are named, minus the excluded ones.
void read_casters(const json& document, const Place& root, Scene& scene) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const json& value = document["lights"][i];
    if (!value.contains("casters")) continue;
    const Place place = root / "lights" / i / "casters";
    const json& casters = value["casters"];
    std::set<std::uint32_t> included, excluded;
    const bool some = casters.contains("include");
    if (some) included = named_objects(casters["include"], place / "include", scene.objects);
    if (casters.contains("exclude")) excluded = named_objects(casters["exclude"], place / "exclude", scene.objects);
    for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
      if (excluded.contains(object) || (some && !included.contains(object)))
        scene.lights[i].unshaded_by.push_back(object);
    }
  }
}

/// Appends the mesh to the scene as the object with index `object`.
void append(mesh::TriangleSoup& soup, mesh::TriangleSoup mesh, std::uint32_t object, const Place& place) {
  const std::size_t positions = soup.positions.size() + mesh.positions.size();
  const std::size_t triangles = soup.triangles.size() + mesh.triangles.size();
  if (positions > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("{}: the scene has more than 2^32 vertices", place.str());
  }
  if (soup.triangles.empty()) {  // the first mesh is usually the largest, and often the only one
    soup = std::move(mesh);
    soup.object.assign(soup.triangles.size(), object);
    return;
  }
  // Each array is copied into a larger one before the old one is freed: the largest array determines the memory needed.
  at_place(place, [&] {
    require_memory(positions * sizeof(glm::dvec3) + mesh::soup_bytes(mesh.triangles.size(), 0),
                   fmt::format("a scene of {} triangles", triangles), "make its meshes smaller");
  });
  const auto first = static_cast<std::uint32_t>(soup.positions.size());
  soup.positions.insert(soup.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const mesh::Triangle& t : mesh.triangles) soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  soup.object.insert(soup.object.end(), mesh.triangles.size(), object);
  soup.source_face.insert(soup.source_face.end(), mesh.source_face.begin(), mesh.source_face.end());
}

/// Throws InputError for another version of the format. Called before all other checks, which that version may not
/// require.
void require_version(const json& document, const std::string& file) {
  constexpr std::string_view kVersions = "penumbra-scene/", kRead = "penumbra-scene/1";
  if (!document.is_object() || !document.contains("format") || !document["format"].is_string()) return;
  const auto& format = document["format"].get_ref<const std::string&>();
  if (format.starts_with(kVersions) && format != kRead) {
    throw InputError("{}: /format: \"{}\" is another version of the format; this program reads \"{}\" alone", file,
                     on_one_line(format), kRead);
  }
}

}  // namespace

Scene read_json(const std::filesystem::path& file, const ReadOptions& options) {
  return read_json_text(read_text_file(file), file, options);
}

Scene read_json_text(std::string_view text, const std::filesystem::path& file, const ReadOptions& options) {
  json document = parse_json(text, file.string());
  require_version(document, file.string());
  enforce_schema(document, file.string());

  const Place root{file.string(), {}};
  Scene scene;
  scene.name = file.filename().string();
  if (document.contains("size")) {
    scene.width = document["size"][0].get<std::uint32_t>();
    scene.height = document["size"][1].get<std::uint32_t>();
  }
  scene.cameras = read_cameras(document, root, scene.warnings);
  scene.lights = read_lights(document, root, options, scene);
  require_room_for_meshes(document["meshes"], root / "meshes", options.instances != nullptr, options.bytes_per_copy);
  for (const json& value : document["meshes"]) {
    if (options.step != nullptr) (*options.step)();
    const std::size_t index = scene.objects.size();
    const Place place = root / "meshes" / index;
    scene.objects.push_back(read_object(value, place, scene.lights, fmt::format("mesh{}", index)));
    const auto object = static_cast<std::uint32_t>(index);
    mesh::TriangleSoup mesh = read_mesh(value, place, options, scene);
    if (options.instances != nullptr && value.contains("instances"))
      add_instances(value["instances"], place / "instances", std::move(mesh), object, scene, *options.instances);
    else
      append(scene.soup, std::move(mesh), object, place);
  }
  read_casters(document, root, scene);
  return scene;
}

}  // namespace penumbra::scenes
