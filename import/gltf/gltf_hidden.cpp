#include "import/gltf/gltf_hidden.hpp"

#include "import/gltf/gltf_accessor.hpp"
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

namespace penumbra::scenes {
namespace {

bool is_emissive(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  if (primitive.material < 0 || static_cast<std::size_t>(primitive.material) >= model.materials.size()) return false;
  const auto& factor = model.materials[static_cast<std::size_t>(primitive.material)].emissiveFactor;
  return std::ranges::any_of(factor, [](double x) { return x > 0; });
}

/// Do all lie on one line, up to the rounding of where they are?
bool are_collinear(std::span<const glm::dvec3> points) {
  double largest = 0;
  for (const glm::dvec3& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  // A transform is four products a coordinate, chained over a few parents; a difference has two such errors.
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
  std::vector<std::string> said;  // for the scene itself
  for (const PlacedNode& placed : place_nodes(model, said))
    places[static_cast<std::size_t>(placed.number)] = placed.to_world;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) model.nodes[i].scale = std::move(posed[i]);
  return places;
}

bool hides_light(const tinygltf::Model& model, const tinygltf::Node& node, const glm::dmat4& to_world,
                 const glm::dmat4& unhidden) {
  if (to_world == unhidden || node.skin >= 0) return false;
  if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size()) return false;
  const auto collapses = [&](const tinygltf::Primitive& primitive) {
    const auto attribute = primitive.attributes.find("POSITION");
    if (!is_emissive(model, primitive) || attribute == primitive.attributes.end()) return false;
    std::vector<glm::dvec3> shown = read_positions(model, attribute->second), whole = shown;
    for (glm::dvec3& p : shown) p = glm::dvec3(to_world * glm::dvec4(p, 1));
    for (glm::dvec3& p : whole) p = glm::dvec3(unhidden * glm::dvec4(p, 1));
    return !shown.empty() && are_collinear(shown) && !are_collinear(whole);
  };
  return std::ranges::any_of(model.meshes[static_cast<std::size_t>(node.mesh)].primitives, collapses);
}

}  // namespace penumbra::scenes
