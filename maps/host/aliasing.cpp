// SPDX-License-Identifier: Apache-2.0
// Measures the aliasing error of fitted maps: Eisemann et al. 2009, equation 3.2; Lloyd et al. 2008.

#include "maps/host/aliasing.hpp"

#include "visibility/receivers.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::maps {
namespace {

/// Returns the displacements of a view sample on its plane when its pixel moves across and down.
std::array<glm::dvec3, 2> moves_of(const visibility::ViewSamples& samples, std::size_t pixel, const SceneSpace& space) {
  const visibility::PinholeCamera& camera = samples.camera;
  const auto x = static_cast<std::uint32_t>(pixel % samples.width),
             y = static_cast<std::uint32_t>(pixel / samples.width);
  const visibility::ViewRay ray = camera.ray(x, y);
  const glm::dvec3 here(samples.p[pixel]), p = space.scene_point(here),
                                           n = space.scene_normal(here, glm::dvec3(samples.n[pixel]));
  const double t = glm::dot(camera.forward, p - ray.start),
               scale = camera.half_height.value_or(t * camera.tan_half_fov);
  const std::array screen{(camera.across(x + 1) - camera.across(x)) * scale * camera.right,
                          (camera.upward(y + 1) - camera.upward(y)) * scale * camera.up};
  std::array<glm::dvec3, 2> moves{};
  for (std::size_t i = 0; i < 2; ++i) {
    moves.at(i) =
        space.moves(here, screen.at(i) - ray.direction * (glm::dot(n, screen.at(i)) / glm::dot(n, ray.direction)));
  }
  return moves;
}

}  // namespace

glm::dvec2 aliasing_error(const FittedFace& face, const SeenReceiver& receiver, const visibility::ViewSamples& samples,
                          std::size_t pixel, const LightBasis& basis, std::uint32_t size, const SceneSpace& space) {
  const auto moves = moves_of(samples, pixel, space);
  std::array<glm::dvec2, 2> texels{};
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::dvec3 by(glm::dot(moves.at(i), basis.u), glm::dot(moves.at(i), basis.v),
                        glm::dot(moves.at(i), basis.n) * (receiver.side == 0 ? 1 : -1));
    texels.at(i) = face.moves(receiver.e, by) * static_cast<double>(size);
  }
  // `texels` holds the texels moved by a step of one pixel; the columns of its inverse are the pixels moved by a step
  // of one texel.
  const double determinant = texels[0].x * texels[1].y - texels[1].x * texels[0].y;
  const double width = std::hypot(texels[1].y, texels[0].y), height = std::hypot(texels[1].x, texels[0].x);
  return glm::dvec2(width, height) / std::max(std::abs(determinant), 1e-300);
}

bool faces_away(const visibility::ViewSamples& samples, std::size_t pixel, const LightBasis& basis) {
  return glm::dot(glm::dvec3(samples.n[pixel]), glm::dvec3(samples.p[pixel]) - basis.center) >= 0;
}

Aliasing measure_aliasing(std::span<const FittedFace> faces, const visibility::SceneFloats& scene,
                          const visibility::Light& light, const visibility::ViewSamples& samples,
                          const LightBasis& basis, std::uint32_t size, const SceneSpace& space) {
  Aliasing result{std::vector<float>(samples.size(), 0.0F), {}};
  std::vector<glm::dvec2> largest(faces.size(), glm::dvec2(0));
  std::uint64_t pixels = 0, under = 0, outside = 0;
  double sum = 0, worst = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!visibility::is_receiver(scene, light, samples, i)) continue;
    const auto receiver = seen_receiver(samples, i, basis, light.two_sided || is_body(light.kind), space);
    if (!receiver) continue;
    if (faces_away(samples, i, basis)) continue;
    const FittedFace* face = face_for(faces, *receiver);
    if (face == nullptr) {
      ++outside;
      continue;
    }
    glm::dvec2 errors = aliasing_error(*face, *receiver, samples, i, basis, size, space);
    for (int axis = 0; axis < 2; ++axis) errors[axis] = std::min(errors[axis], kMostAliasing);
    glm::dvec2& most = largest[static_cast<std::size_t>(face - faces.data())];
    most = glm::max(most, errors);
    const double error = std::max(errors.x, errors.y);
    result.errors[i] = static_cast<float>(error);
    ++pixels;
    under += error > 1 ? 1 : 0;
    sum += error;
    worst = std::max(worst, error);
  }
  double needed = 0;
  for (const glm::dvec2& most : largest) needed += most.x * most.y * size * size;
  const auto whole = [](double x) { return static_cast<std::uint64_t>(std::llround(std::min(x, 1e18))); };
  result.counters = {{"aliasingPixels", pixels},
                     {"outsidePixels", outside},
                     {"undersampledPixels", under},
                     {"aliasingThousandths", whole(1000 * sum)},
                     {"aliasingWorstThousandths", whole(1000 * worst)},
                     {"neededTexels", whole(needed)}};
  return result;
}

}  // namespace penumbra::maps
