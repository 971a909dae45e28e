// SPDX-License-Identifier: Apache-2.0
// Finds lamps that an animation hides by a scale of 0. The nodes are placed a second time, as if nothing were scaled to
// 0. An emissive mesh is hidden if its points lie on one line as shown, but not in that second placement.

#include "import/gltf/gltf_hidden.hpp"

#include "base/error.hpp"
#include "import/gltf/gltf_accessor.hpp"
#include "import/gltf/gltf_deform.hpp"
#include "import/gltf/gltf_nodes.hpp"

#include <tiny_gltf.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>

namespace penumbra::import {
namespace {

bool is_emissive(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  if (primitive.material < 0 || static_cast<std::size_t>(primitive.material) >= model.materials.size()) return false;
  const auto& factor = model.materials[static_cast<std::size_t>(primitive.material)].emissiveFactor;
  return std::ranges::any_of(factor, [](double x) { return x > 0; });
}

/// Returns whether all points lie on one line, up to the rounding of their positions.
bool are_collinear(std::span<const glm::dvec3> points) {
  double largest = 0;
  for (const glm::dvec3& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  // A transform is four products for each coordinate, chained over a few parents; a difference has two such errors.
  const double rounding = 64 * std::numeric_limits<double>::epsilon() * largest;
  const auto farthest =
      std::ranges::max_element(points, {}, [&](const glm::dvec3& p) { return glm::distance(p, points.front()); });
  const glm::dvec3 along = *farthest - points.front();
  return std::ranges::all_of(points, [&](const glm::dvec3& p) {
    return glm::length(glm::cross(p - points.front(), along)) <= 2 * rounding * (glm::length(along) + rounding);
  });
}

}  // namespace

std::vector<std::vector<double>> rest_scales(const tinygltf::Model& model) {
  std::vector<std::vector<double>> scales;
  for (const tinygltf::Node& node : model.nodes) scales.push_back(node.scale);
  return scales;
}

std::vector<std::optional<glm::dmat4>> unhidden_places(tinygltf::Model& model,
                                                       const std::vector<std::vector<double>>& rest) {
  std::vector<std::vector<double>> posed = rest_scales(model);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    std::vector<double>& scale = model.nodes[i].scale;
    for (std::size_t axis = 0; axis < scale.size(); ++axis) {
      if (scale[axis] == 0) scale[axis] = axis < rest[i].size() && rest[i][axis] != 0 ? rest[i][axis] : 1;
    }
  }
  std::vector<std::optional<glm::dmat4>> places(model.nodes.size());
  std::vector<std::string> said;  // warnings that the scene itself reports; ignored here
  for (const PlacedNode& placed : place_nodes(model, said))
    places[static_cast<std::size_t>(placed.number)] = placed.to_world;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) model.nodes[i].scale = std::move(posed[i]);
  return places;
}

std::optional<glm::dvec3> hidden_light(const tinygltf::Model& model, int number, Places shown, Places unhidden) {
  const auto index = static_cast<std::size_t>(number);
  const tinygltf::Node& node = model.nodes.at(index);
  if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size() || index >= unhidden.size() ||
      (node.skin < 0 && shown[index] == unhidden[index])) {
    return std::nullopt;
  }
  const auto& primitives = model.meshes[static_cast<std::size_t>(node.mesh)].primitives;
  std::optional<glm::dvec3> point;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const std::string place = fmt::format("/meshes/{}/primitives/{}", node.mesh, i);
    const auto placed = [&](Places places) {
      const auto attribute = primitives[i].attributes.find("POSITION");
      std::vector<glm::dvec3> positions;
      if (attribute != primitives[i].attributes.end()) positions = read_positions(model, attribute->second);
      const auto skinned = skin(model, {node, places[index].value()}, primitives[i], place, places);
      for (std::size_t vertex = 0; vertex < positions.size(); ++vertex) {
        const glm::dmat4& to_world =
            skinned && vertex < skinned->vertices.size() ? skinned->vertices[vertex] : places[index].value();
        positions[vertex] = glm::dvec3(to_world * glm::dvec4(positions[vertex], 1));
      }
      // positions that no triangle uses
      std::erase_if(positions, [](const glm::dvec3& p) { return !std::isfinite(p.x + p.y + p.z); });
      return positions;
    };
    const bool emissive = is_emissive(model, primitives[i]);
    if (!emissive && node.skin < 0) continue;
    const std::vector<glm::dvec3> left = placed(shown);
    if (left.empty()) continue;
    const bool squashed = are_collinear(left);
    if (!squashed && node.skin >= 0) return std::nullopt;
    if (emissive && squashed && !are_collinear(placed(unhidden))) point = left.front();
  }
  return point;
}

}  // namespace penumbra::import
