#include "import/gltf/area_lamp.hpp"

#include "base/error.hpp"

#include <tiny_gltf.h>

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace penumbra::scenes {
namespace {

template <std::size_t N>
std::array<double, N> numbers(const tinygltf::Value& lamp, const char* key, double least, const std::string& place) {
  std::array<double, N> all{};
  const tinygltf::Value& list = lamp.Get(key);
  bool good = list.IsArray() && list.ArrayLen() == N;
  for (std::size_t i = 0; good && i < N; ++i) {
    const tinygltf::Value& value = list.Get(static_cast<int>(i));
    all[i] = value.IsNumber() ? value.GetNumberAsDouble() : -1;
    good = std::isfinite(all[i]) && all[i] >= least;
  }
  if (!good) throw InputError("{}/{}: expected {} numbers from {} up", place, key, N, least);
  return all;
}

/// Returns whether u and v span a circle, up to the rounding of a transform in single precision.
bool is_round(const glm::dvec3& u, const glm::dvec3& v) {
  const double rounding = 8 * static_cast<double>(std::numeric_limits<float>::epsilon()) * glm::dot(u, u);
  return std::abs(glm::dot(u, v)) <= rounding && std::abs(glm::dot(u, u) - glm::dot(v, v)) <= rounding;
}

}  // namespace

std::optional<AreaLight> area_lamp_of(const tinygltf::Node& node, const PlacedNode& placed, Losses& losses) {
  if (!node.extras.IsObject() || !node.extras.Has("areaLamp")) return std::nullopt;
  const std::string place = fmt::format("/nodes/{}/extras/areaLamp", placed.number);
  const tinygltf::Value& lamp = node.extras.Get("areaLamp");
  if (!lamp.IsObject() || !lamp.Has("shape") || !lamp.Has("size") || !lamp.Has("radiance")) {
    losses.mention("has extras \"areaLamp\" of another tool (no shape, size and radiance), which are left out",
                   node.name);
    return std::nullopt;
  }
  const auto size = numbers<2>(lamp, "size", 0, place);
  const auto radiance = numbers<3>(lamp, "radiance", 0, place);
  const glm::dvec3 center(placed.to_world[3]);
  const glm::dvec3 u = size[0] / 2 * glm::dvec3(placed.to_world[0]);
  glm::dvec3 v = size[1] / 2 * glm::dvec3(placed.to_world[1]);
  const glm::dvec3 along = -glm::dvec3(placed.to_world[2]);
  if (!(glm::length(glm::cross(u, v)) > 0)) throw InputError("{}: it has no area in the world", place);
  if (glm::dot(glm::cross(u, v), along) < 0) v = -v;  // the light must shine along u × v
  AreaLight light;
  light.radiance = {radiance[0], radiance[1], radiance[2]};
  const tinygltf::Value& shape = lamp.Get("shape");
  const std::string kind = shape.IsString() ? shape.Get<std::string>() : "";
  if (kind == "rectangle") {
    light.shape = Rectangle{center, u, v};
  } else if (kind == "ellipse") {
    if (is_round(u, v))
      light.shape = Disk{center, glm::normalize(glm::cross(u, v)), glm::length(u)};
    else
      light.shape = Ellipse{center, u, v};
  } else {
    throw InputError("{}/shape: expected \"rectangle\" or \"ellipse\"", place);
  }
  return light;
}

}  // namespace penumbra::scenes
