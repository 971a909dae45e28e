// SPDX-License-Identifier: Apache-2.0
// Computes screen-space ambient occlusion: Mittring 2007, "Finding next gen: CryEngine 2", as described by
// Akenine-Möller, Haines and Hoffman (2008) and the course notes of Eisemann et al. (2009, section 6.2): points in a
// ball around the view sample are hidden if the picture's depth is nearer; a plane hides half of the ball, so V is
// twice the fraction of the others. Departures: points fill the ball evenly, in pairs around its middle, instead of at
// random; the outside of the picture hides nothing.

#include "maps/screen/methods.hpp"

#include "maps/host/mesh_verdict.hpp"
#include "maps/screen/screen_method.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

enum class Around : std::uint8_t { ball, hemisphere };

constexpr visibility::IntegerOption kSamples{"samples", 2, 4096, 16, "points around a view sample; an even number"};
constexpr visibility::ChoiceOption kAround{
    "around",
    {{"ball", Around::ball}, {"hemisphere", Around::hemisphere}},
    Around::ball,
    "region of the points: the ball, as published; or the half above the surface, where a plane hides none"};
constexpr auto kRange = visibility::flag_option(
    "range", false,
    "on: surfaces nearer to the camera by more than the radius hide no points, which avoids dark rims behind objects");

/// Returns direction i of `count` spread evenly over the sphere (Fibonacci's spiral).
glm::dvec3 spread(std::uint32_t i, std::uint32_t count) {
  const double z = 1 - (2 * i + 1.0) / count, across = std::sqrt(std::max(0.0, 1 - z * z));
  const double turn = 2 * std::numbers::pi * std::fmod(i * (std::numbers::phi - 1), 1.0);
  return {across * std::cos(turn), across * std::sin(turn), z};
}

/// Returns the radical inverse of i: its digits in base 2, mirrored at the point.
double mirrored(std::uint32_t i) {
  double value = 0, digit = 0.5;
  for (; i != 0; i >>= 1, digit /= 2) value += digit * (i & 1U);
  return value;
}

/// Returns points that fill the unit ball evenly, each with its opposite.
std::vector<glm::dvec3> ball(std::uint32_t count) {
  std::vector<glm::dvec3> points;
  const std::uint32_t pairs = std::max((count + 1) / 2, 1U);
  for (std::uint32_t i = 0; i < pairs; ++i) {
    const glm::dvec3 at = std::cbrt(mirrored(i) + 0.5 / pairs) * spread(i, pairs);
    points.push_back(at);
    points.push_back(-at);
  }
  return points;
}

struct Ssao {
  Around around;
  bool range;
  std::vector<glm::dvec3> points;
  std::array<glm::dvec3, kDithers> mirrors;  ///< normals of planes at which the points are mirrored

  double operator()(const ScreenPicture& picture, std::size_t pixel, double radius, std::uint32_t dither) const {
    const glm::dvec3 middle = picture.point(pixel), &n = picture.normal(pixel), &mirror = mirrors[dither];
    std::size_t hidden = 0;
    for (glm::dvec3 at : points) {
      if (dither != 0) at -= 2 * glm::dot(at, mirror) * mirror;
      if (around == Around::hemisphere && glm::dot(at, n) < 0) at = -at;
      const glm::dvec3 point = middle + radius * at;
      const auto place = picture.place_of(point);
      if (!place) continue;
      const auto seen = picture.surface_at(*place);
      if (!seen || point.z >= picture.point(*seen).z) continue;
      if (range && picture.point(*seen).z > middle.z + radius) continue;
      ++hidden;
    }
    const double free = 1 - static_cast<double>(hidden) / static_cast<double>(points.size());
    return around == Around::ball ? std::min(1.0, 2 * free) : free;
  }
};

visibility::MeshVerdict ssao_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps(
      "the fraction of a ball around the view sample that is in front of the surfaces that the camera sees", mesh);
}

}  // namespace

std::unique_ptr<visibility::Method> make_ssao(const visibility::MethodOptions& options) {
  visibility::MethodDescription description = screen_description("ssao", "Mittring 2007");
  description.exact_for = "nothing; V is 1 on a plane, and one half where two planes meet at a right angle";
  description.verdict_on = ssao_verdict;
  for (const auto& option : {kSamples.description(), kAround.description(), kRange.description()})
    description.options.push_back(option);
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  Ssao ssao{parsed[kAround], parsed[kRange], ball(parsed[kSamples]), {}};
  for (std::uint32_t i = 0; i < kDithers; ++i) ssao.mirrors[i] = spread(i, kDithers);
  return make_screen_method(std::move(description), parsed, std::move(ssao));
}

}  // namespace penumbra::maps
