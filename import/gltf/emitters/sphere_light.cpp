// SPDX-License-Identifier: Apache-2.0
// Recognises meshes that approximate a sphere, by a least-squares fit of the centre. Not from a paper.

#include "import/gltf/emitters/sphere_light.hpp"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::import {
namespace {

constexpr double kNearest = 0.98;  // least distance of a triangle's plane from the centre, relative to the radius
/// Largest deviation of corners from one sphere, relative to its radius: a hundredth of the tolerance for planes.
/// Blender's spheres, computed in single precision from angles, are up to 2e-6 off.
constexpr double kUneven = (1 - kNearest) / 100;

/// Returns the centre that fits |p − c|² = r² best for all points: least squares of 2 c · p + (r² − |c|²) = |p|², which
/// is linear. Points are taken relative to their mean and scaled to 1, so that nothing cancels.
std::optional<glm::dvec3> center_of(std::span<const glm::dvec3> points) {
  glm::dvec3 mean(0);
  for (const glm::dvec3& p : points) mean += p / static_cast<double>(points.size());
  double scale = 0;
  for (const glm::dvec3& p : points) scale = std::max(scale, glm::distance(p, mean));
  if (!(scale > 0)) return std::nullopt;
  glm::dmat4 normal(0);
  glm::dvec4 right(0);
  for (const glm::dvec3& p : points) {
    const glm::dvec3 q = (p - mean) / scale;
    const glm::dvec4 row(2.0 * q, 1);
    normal += glm::outerProduct(row, row);
    right += glm::dot(q, q) * row;
  }
  const double size = glm::determinant(normal);
  if (!(std::abs(size) > 0) || !std::isfinite(size)) return std::nullopt;
  const glm::dvec4 solution = glm::inverse(normal) * right;
  return mean + scale * glm::dvec3(solution);
}

}  // namespace

std::optional<scenes::Sphere> recognise_sphere(const Welded& mesh, double rounding) {
  const std::vector<glm::dvec3>& positions = mesh.points;
  const auto center = center_of(positions);
  if (!center) return std::nullopt;
  double least = glm::distance(positions.front(), *center), most = least;
  for (const glm::dvec3& p : positions) {
    least = std::min(least, glm::distance(p, *center));
    most = std::max(most, glm::distance(p, *center));
  }
  // Corners are off by the rounding, and so is the centre computed from them.
  if (!(least > 0) || most - least > std::max(8 * rounding, kUneven * most)) return std::nullopt;
  double solid_angle = 0, area = 0;
  for (const mesh::Triangle& t : mesh.triangles) {
    const glm::dvec3 a = positions[t[0]] - *center, b = positions[t[1]] - *center, c = positions[t[2]] - *center;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double twice = glm::length(normal);
    if (twice == 0) continue;  // at a pole
    if (glm::dot(normal, a) < kNearest * most * twice) return std::nullopt;
    area += twice / 2;
    // Van Oosterom and Strackee 1983; all three lengths are about `most`.
    const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
    solid_angle += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                  x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y);
  }
  // The angles must add up to one full sphere, up to the rounding of a sum of that many angles.
  if (std::abs(solid_angle - 4 * std::numbers::pi) > 1e-9 * static_cast<double>(mesh.triangles.size()) + 1e-6)
    return std::nullopt;
  return scenes::Sphere{*center, std::sqrt(area / (4 * std::numbers::pi)), {}};
}

}  // namespace penumbra::import
