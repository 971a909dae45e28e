// SPDX-License-Identifier: Apache-2.0
// Selects the baked mesh of a scene and its points: texels of a lightmap, or vertices with angle-weighted points.

#include "app/bake/baked_mesh.hpp"

#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "scenes/whole_view.hpp"
#include "session/whole_lights.hpp"

#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

namespace penumbra::app {
namespace {

constexpr double kInset = 1.0 / 256;  // distance of a point from its vertex; 1: the middle of the triangle

/// Returns the angle of a triangle at its corner k; 0 for a triangle without area.
double angle_at(const mesh::TriangleSoup& soup, const mesh::Triangle& triangle, std::size_t k) {
  const glm::dvec3 at = soup.positions[triangle[k]];
  const glm::dvec3 to = soup.positions[triangle[(k + 1) % 3]] - at, other = soup.positions[triangle[(k + 2) % 3]] - at;
  return std::atan2(glm::length(glm::cross(to, other)), glm::dot(to, other));
}

std::vector<glm::dvec3> positions_of(const scenes::Scene& scene, const BakedMesh& mesh) {
  std::vector<glm::dvec3> positions;
  for (const std::uint32_t triangle : mesh.triangles) {
    for (const std::uint32_t vertex : scene.soup.triangles[triangle]) positions.push_back(scene.soup.positions[vertex]);
  }
  return positions;
}

/// Returns whether the name is `whole`, or one of the parts of a glTF mesh with several materials: `whole`/0, `whole`/1
/// …
bool is_of(const std::string& name, const std::string& whole) {
  if (!name.starts_with(whole)) return false;
  const std::string_view rest = std::string_view(name).substr(whole.size());
  return rest.empty() || (rest.size() > 1 && rest[0] == '/' &&
                          std::ranges::all_of(rest.substr(1), [](char c) { return c >= '0' && c <= '9'; }));
}

}  // namespace

BakedMesh find_baked(const scenes::Scene& scene, const std::string& name) {
  BakedMesh mesh;
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (is_of(scene.objects[i].name, name)) mesh.objects.push_back(i);
    names.push_back(scene.objects[i].name);
  }
  if (mesh.objects.empty()) {
    constexpr std::size_t kMost = 16;
    const std::string near = did_you_mean(name, names);
    const bool more = names.size() > kMost;
    if (more) names.resize(kMost);
    throw UsageError("--mesh {}: {} has no mesh of that name; it has: {}{}{}", name, scene.name, fmt::join(names, ", "),
                     more ? " and others" : "", near);
  }
  for (std::uint32_t i = 0; i < scene.soup.triangles.size(); ++i) {
    if (std::ranges::find(mesh.objects, scene.soup.object[i]) != mesh.objects.end()) mesh.triangles.push_back(i);
  }
  return mesh;
}

void prepare_scene(scenes::Scene& scene, const BakedMesh& mesh) {
  for (scenes::Object& object : scene.objects) object.color = glm::dvec3(1);
  for (scenes::Picture& picture : scene.pictures) {
    for (auto& texel : picture.texels) texel[0] = texel[1] = texel[2] = 255;
  }
  for (glm::vec4& color : scene.looks.colors) color = glm::vec4(1, 1, 1, color.w);
  scene.cameras = {scenes::camera_that_sees_all(scenes::bounds_of(positions_of(scene, mesh)))};
}

std::vector<visibility::SurfacePoint> lightmap_points(const scenes::Scene& scene, const BakedMesh& mesh,
                                                      const scenes::LightmapPlaces& lightmap, std::uint32_t width,
                                                      std::uint32_t height, std::vector<std::string>& notes) {
  std::vector<std::uint32_t> mapped;
  for (const std::uint32_t triangle : mesh.triangles) {
    const auto has_place = [&](std::uint32_t vertex) { return lightmap.places[vertex] != scenes::kNoPlace; };
    if (std::ranges::all_of(scene.soup.triangles[triangle], has_place)) mapped.push_back(triangle);
  }
  const std::string& name = scene.objects[mesh.objects.front()].name;
  if (mapped.empty())
    throw InputError(
        "mesh \"{}\" has no coordinates of set {} (--uv); glTF has TEXCOORD_{}, OBJ has vt, a quad of JSON "
        "has its own; --vertices needs none",
        name, lightmap.set, lightmap.set);
  visibility::TexelPoints texels =
      visibility::texel_points(scene.soup.triangles, mapped, lightmap.places, width, height);
  if (texels.covered == 0)
    throw InputError(
        "mesh \"{}\" covers no texel's centre of {}x{} with its coordinates of set {}; they run from 0 to 1", name,
        width, height, lightmap.set);
  const std::uint64_t unmapped = texels.unmapped + mesh.triangles.size() - mapped.size();
  if (unmapped > 0)
    notes.push_back(fmt::format("{} of {} triangles have no coordinates, or no area there, and are not in the map",
                                unmapped, mesh.triangles.size()));
  if (texels.outside > 0)
    notes.push_back(fmt::format("{} triangles leave the map; what lies outside is not baked", texels.outside));
  if (texels.overlaps > 0)
    notes.push_back(
        fmt::format("{} times a texel lies inside a further triangle; it belongs to the first one", texels.overlaps));
  return std::move(texels.points);
}

VertexPoints vertex_points(const scenes::Scene& scene, const BakedMesh& mesh, std::uint32_t width) {
  VertexPoints all;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(scene.soup.positions.size(), kNone);
  for (const std::uint32_t triangle : mesh.triangles) {
    mesh::Triangle corners = scene.soup.triangles[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      glm::dvec3 shares(kInset / 3);
      shares[static_cast<glm::length_t>(k)] += 1 - kInset;
      all.points.push_back({static_cast<std::int32_t>(triangle), shares});
      all.weights.push_back(angle_at(scene.soup, corners, k));
    }
    for (std::uint32_t& corner : corners) {
      if (number[corner] == kNone) {
        number[corner] = static_cast<std::uint32_t>(all.vertices.size());
        all.vertices.push_back(corner);
      }
      corner = number[corner];
    }
    all.triangles.push_back(corners);
  }
  all.points.resize((all.points.size() + width - 1) / width * width);
  return all;
}

void make_irradiance(session::RenderedFrame& frame, const session::Session& session) {
  constexpr auto kPi = std::numbers::pi_v<float>;
  const std::vector<session::WholeLight> lights = session::whole_lights(session.lights);
  for (std::size_t light = 0; light < frame.beauty.size(); ++light) {
    const std::int32_t index = session.lights[lights[light].first].index;
    for (std::size_t i = 0; i < frame.beauty[light].size(); ++i) {
      const std::int32_t triangle = session.samples.triangle[i];
      const bool own = triangle >= 0 && session.floats.emits[static_cast<std::size_t>(triangle)] == index;
      frame.beauty[light][i] *= own ? 0.0F : kPi;
    }
  }
  std::ranges::fill(frame.sum, glm::vec3(0));
  for (const std::vector<glm::vec3>& part : frame.beauty) {
    for (std::size_t i = 0; i < part.size(); ++i) frame.sum[i] += part[i];
  }
}

void fill_margins(session::RenderedFrame& frame, std::span<const std::int64_t> sources) {
  const auto fill = [&](auto& values, const auto& nothing) {
    if (values.empty()) return;
    const auto before = values;
    for (std::size_t i = 0; i < sources.size(); ++i)
      values[i] = sources[i] < 0 ? nothing : before[static_cast<std::size_t>(sources[i])];
  };
  for (std::vector<float>& light : frame.visibility) fill(light, 0.0F);
  for (std::vector<glm::vec3>& light : frame.beauty) fill(light, glm::vec3(0));
  fill(frame.sum, glm::vec3(0));
}

}  // namespace penumbra::app
