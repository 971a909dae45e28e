// SPDX-License-Identifier: Apache-2.0
// Makes subjects: shipped scenes, torus knots, spheres, with variations of light and size.

#include "bench/subject.hpp"

#include "base/error.hpp"
#include "scenes/formats/reader.hpp"
#include "session/parse.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

namespace penumbra::bench {
namespace {

constexpr const char* kLarge = "terrain-1m";
constexpr std::string_view kKnot = "knot:", kSphere = "sphere:";

double parse_half(const std::string& text) {
  char* end = nullptr;
  const double half = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(half > 0 && half < 1e9))
    throw UsageError("--light-half {}: expected a length above 0, such as 0.3", text);
  return half;
}

std::filesystem::path find_scene(const std::string& name) {
  if (std::filesystem::is_regular_file(name)) return name;
  std::filesystem::path shipped = std::filesystem::path(PENUMBRA_SCENES) / (name + ".json");
  if (std::filesystem::is_regular_file(shipped)) return shipped;
  throw UsageError("--scene {}: neither a file, nor a scene of {}, nor knot:TRIANGLES or sphere:TRIANGLES", name,
                   PENUMBRA_SCENES);
}

std::vector<std::string> shipped_scenes(bool all) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_SCENES)) {
    const std::filesystem::path& path = entry.path();
    const std::string stem = path.stem().string();
    if (path.extension() != ".json" || stem.ends_with(".schema") || (stem == kLarge && !all)) continue;
    names.push_back(stem);
  }
  std::ranges::sort(names);
  return names;
}

Subject find_subject(const std::string& scene) {
  Subject subject;
  const auto triangles_after = [&](std::string_view shape) {
    const auto triangles = session::parse_integer<std::uint64_t>(std::string_view(scene).substr(shape.size()));
    if (!triangles) throw UsageError("--scene {}: expected a number of triangles, such as {}5000", scene, shape);
    return *triangles;
  };
  if (scene.starts_with(kKnot)) {
    subject.knot = triangles_after(kKnot);
    static_cast<void>(knot_of(subject.knot));  // throws now if there is no such knot
    subject.name = fmt::format("knot-{}", subject.knot);
  } else if (scene.starts_with(kSphere)) {
    subject.sphere = triangles_after(kSphere);
    static_cast<void>(sphere_of(subject.sphere));
    subject.name = fmt::format("sphere-{}", subject.sphere);
  } else {
    subject.scene = find_scene(scene);
    subject.name = subject.scene.stem().string();
  }
  return subject;
}

visibility::LightKind parse_kind(const std::string& text) {
  constexpr visibility::LightKinds kOthers = visibility::kEveryLight - visibility::kParallelograms;
  for (const visibility::LightKind kind : kOthers.list()) {
    if (text == visibility::name_of(kind)) return kind;
  }
  throw UsageError("--light {}: expected {}", text, kOthers.words(" or "));
}

visibility::SamplePattern parse_pattern(const std::string& text) {
  using enum visibility::SamplePattern;
  for (const auto pattern : {rows, grid, sobol, jittered, rgss}) {
    if (text == visibility::name_of(pattern)) return pattern;
  }
  throw UsageError("--sample-pattern {}: expected rows, grid, sobol, jittered or rgss", text);
}

/// Replaces each subject by one for each value, set by `set`; keeps the subjects if there are no values.
template <typename Value, typename Set>
void multiply(std::vector<Subject>& subjects, const std::vector<Value>& values, const std::string& name, Set set) {
  if (values.empty()) return;
  std::vector<Subject> all;
  for (const Subject& subject : subjects) {
    for (const Value& value : values) {
      all.push_back(subject);
      all.back().name += fmt::format("/{}={}", name, value);
      set(all.back(), value);
    }
  }
  subjects = std::move(all);
}

scenes::Rectangle& first_rectangle(scenes::Scene& scene, const char* option) {
  auto* rectangle = std::get_if<scenes::Rectangle>(&scene.lights.front().shape);
  if (rectangle == nullptr) throw UsageError("{}: the first light of {} is not a rectangle", option, scene.name);
  return *rectangle;
}

void resize_first_light(scenes::Scene& scene, double half) {
  scenes::Rectangle& rectangle = first_rectangle(scene, "--light-half");
  rectangle.half_u = glm::normalize(rectangle.half_u) * half;
  rectangle.half_v = glm::normalize(rectangle.half_v) * half;
}

/// Replaces a rectangle light by one of the same area: a disk; an ellipse along the rectangle's sides with one axis
/// twice the other; or an affine image of a regular hexagon. A sphere is as wide as the disk. A sun shines from the
/// light to the middle of the meshes, with the apparent size of the disk seen from there.
void reshape_first_light(scenes::Scene& scene, visibility::LightKind kind) {
  const scenes::Rectangle from = first_rectangle(scene, "--light");
  const glm::dvec3 normal = glm::cross(from.half_u, from.half_v);
  const double round = std::sqrt(4 * glm::length(normal) / std::numbers::pi);
  if (kind == visibility::LightKind::sphere) {
    scene.lights.front().shape = scenes::Sphere{from.center, round, std::nullopt};
    return;
  }
  if (kind == visibility::LightKind::sun) {
    glm::dvec3 low(scene.soup.positions.front()), high(low);
    for (const glm::dvec3& x : scene.soup.positions) {
      low = glm::min(low, x);
      high = glm::max(high, x);
    }
    const glm::dvec3 travels = 0.5 * (low + high) - from.center;
    scene.lights.front().shape = scenes::Sun{travels, glm::degrees(2 * std::atan(round / glm::length(travels)))};
    return;
  }
  if (kind == visibility::LightKind::disk) {
    scene.lights.front().shape = scenes::Disk{from.center, glm::normalize(normal), round};
    return;
  }
  if (kind == visibility::LightKind::ellipse) {
    const double axis = std::sqrt(2 / std::numbers::pi);  // π · axis · 2 axis = 4
    scene.lights.front().shape = scenes::Ellipse{from.center, 2 * axis * from.half_u, axis * from.half_v};
    return;
  }
  scenes::Polygon hexagon;
  const double radius = std::sqrt(8 / (3 * std::sqrt(3.0)));  // circumradius of a regular hexagon with area 4
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3;
    hexagon.vertices.push_back(from.center + radius * (std::cos(angle) * from.half_u + std::sin(angle) * from.half_v));
  }
  scene.lights.front().shape = hexagon;
}

void append(scenes::Scene& scene, const std::string& name, const mesh::TriangleSoup& soup) {
  const auto first = static_cast<std::uint32_t>(scene.soup.positions.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.soup.positions.insert(scene.soup.positions.end(), soup.positions.begin(), soup.positions.end());
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const mesh::Triangle& t = soup.triangles[i];
    scene.soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    scene.soup.object.push_back(object);
    scene.soup.source_face.push_back(soup.source_face[i]);
  }
  scenes::Object made;
  made.name = name;
  scene.objects.push_back(made);
}

}  // namespace

std::vector<Subject> make_subjects(const SubjectRequest& request) {
  const bool shipped = request.scenes.empty();
  const std::vector<std::string> names = shipped ? shipped_scenes(request.all) : request.scenes;
  std::vector<Subject> subjects;
  for (const std::string& name : names) {
    const Subject scene = find_subject(name);
    std::vector<Subject> its{scene};
    const bool more = shipped && request.halves.empty() && name == "bunny";  // in addition to the bunny's own half size
    multiply(its, more ? std::vector<std::string>{"0.3", "2"} : request.halves, "half",
             [](Subject& subject, const std::string& half) { subject.light_half = parse_half(half); });
    if (more) its.insert(its.begin(), scene);
    multiply(its, request.lights, "light",
             [](Subject& subject, const std::string& kind) { subject.light_kind = parse_kind(kind); });
    multiply(its, request.patterns, "pattern",
             [](Subject& subject, const std::string& pattern) { subject.pattern = parse_pattern(pattern); });
    multiply(its, request.sizes, "size", [](Subject& subject, std::uint32_t size) { subject.size = size; });
    subjects.insert(subjects.end(), its.begin(), its.end());
  }
  return subjects;
}

scenes::Scene read_subject(const Subject& subject) {
  scenes::Scene scene = subject.knot != 0     ? knot_scene(subject.knot)
                        : subject.sphere != 0 ? sphere_scene(subject.sphere)
                                              : scenes::read_scene(subject.scene);
  if (subject.light_half) resize_first_light(scene, *subject.light_half);
  if (subject.light_kind) reshape_first_light(scene, *subject.light_kind);
  return scene;
}

namespace {

/// Divides half of the number of triangles into two factors of at least three, the second as near as possible to
/// `ratio` times the first. Returns nullopt if there are none.
std::optional<std::pair<std::uint32_t, std::uint32_t>> divided(std::uint64_t triangles, double ratio) {
  constexpr std::uint64_t kFewest = 3;
  const double wanted = std::sqrt(static_cast<double>(triangles) / 2 / ratio);
  std::uint64_t best = 0;
  const auto off = [&](std::uint64_t first) { return std::abs(std::log(static_cast<double>(first) / wanted)); };
  const std::uint64_t half = triangles % 2 == 0 && triangles <= mesh::kMaxShapeTriangles ? triangles / 2 : 0;
  for (std::uint64_t small = 1; small * small <= half; ++small) {
    if (half % small != 0) continue;
    for (const std::uint64_t first : {small, half / small}) {
      if (first >= kFewest && half / first >= kFewest && (best == 0 || off(first) < off(best))) best = first;
    }
  }
  if (best == 0) return std::nullopt;
  return std::pair(static_cast<std::uint32_t>(best), static_cast<std::uint32_t>(half / best));
}

/// Returns a scene with `shape` on or above a floor, under a square light, seen by a camera like that of the default
/// scene.
scenes::Scene scene_around(const std::string& name, const mesh::TriangleSoup& shape, std::uint64_t triangles) {
  scenes::Scene scene;
  scene.name = fmt::format("{}-{}", name, triangles);
  append(scene, name, shape);
  append(scene, "floor", mesh::make_quad({0, 0, 0}, {6, 0, 0}, {0, 0, -6}));
  scenes::AreaLight light;
  light.name = "key";
  light.shape = scenes::Rectangle{{0.5, 5, 0.5}, {1, 0, 0}, {0, 0, 1}};
  scene.lights.push_back(light);
  scenes::Camera camera;
  camera.eye = {4, 3, 5};
  camera.target = {0, 0.8, 0};
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace

mesh::KnotShape knot_of(std::uint64_t triangles) {
  const auto sides = divided(triangles, 4);
  if (!sides) throw UsageError("there is no knot of {} triangles: it has 2 · segments · sides", triangles);
  mesh::KnotShape knot;
  knot.center = {0, 1, 0};
  knot.radius = 0.8;
  knot.sides = sides->first;
  knot.segments = sides->second;
  return knot;
}

scenes::Scene knot_scene(std::uint64_t triangles) {
  return scene_around("knot", mesh::make_knot(knot_of(triangles)), triangles);
}

mesh::SphereShape sphere_of(std::uint64_t triangles) {
  const auto rings = divided(triangles, 2);
  if (!rings) throw UsageError("there is no sphere of {} triangles: it has 2 · segments · (rings − 1)", triangles);
  mesh::SphereShape sphere;
  sphere.center = {0, 1, 0};
  sphere.rings = rings->first + 1;
  sphere.segments = rings->second;
  return sphere;
}

scenes::Scene sphere_scene(std::uint64_t triangles) {
  return scene_around("sphere", mesh::make_sphere(sphere_of(triangles)), triangles);
}

}  // namespace penumbra::bench
