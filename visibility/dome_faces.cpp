// SPDX-License-Identifier: Apache-2.0
// Faces of a dome's cube as lights, and integrals over its light samples.

#include "visibility/dome_faces.hpp"

#include "base/assert.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace penumbra::visibility {
namespace {

bool is_side(std::size_t face) {
  return face < 4;
}

/// For each face, the axes (negative: reversed) of its middle, u and v: v of a side face is up.
constexpr std::array<std::array<int, 3>, kDomeFaces> kFaces{
    {{1, -2, 3}, {-1, 2, 3}, {2, 1, 3}, {-2, -1, 3}, {3, 2, 1}, {-3, 1, 2}}};

}  // namespace

DomeFace dome_face(const Light::Dome& dome, std::size_t face) {
  const auto axis = [&](int number) {
    const glm::vec3& stored = dome.axes[static_cast<std::size_t>(std::abs(number) - 1)];
    return (number < 0 ? -stored : stored) + 0.0f;
  };
  const auto& [middle, u, v] = kFaces.at(face);
  return {axis(middle), axis(u), axis(v)};
}

std::size_t dome_face_of(const Light::Dome& dome, const glm::vec3& direction) {
  const glm::dvec3 d(direction), a(dome.axes[0]), b(dome.axes[1]), c(dome.axes[2]);
  const std::array along{glm::dot(d, glm::cross(b, c)), glm::dot(d, glm::cross(c, a)), glm::dot(d, glm::cross(a, b))};
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(along.at(i)) > std::abs(along.at(largest))) largest = i;
  }
  return 2 * largest + (along.at(largest) < 0 ? 1 : 0);
}

glm::dvec2 dome_face_place(const Light::Dome& dome, std::size_t face, const glm::vec3& direction) {
  const auto [middle, u, v] = dome_face(dome, face);
  const glm::dvec3 d(direction), m(middle), across(u), along(v);
  const double depth = glm::dot(d, glm::cross(across, along));
  return glm::clamp(glm::dvec2(glm::dot(d, glm::cross(along, m)), glm::dot(d, glm::cross(m, across))) / depth, -1.0,
                    1.0);
}

std::array<glm::dvec2, 4> dome_face_corners(const Light& face) {
  PENUMBRA_ASSERT(face.dome && face.dome->face >= 0, "light {} is no face of a dome", face.name);
  const bool upper = face.dome->half && is_side(static_cast<std::size_t>(face.dome->face));
  const double low = upper ? 0 : -1;
  return {glm::dvec2(-1, low), glm::dvec2(1, low), glm::dvec2(1, 1), glm::dvec2(-1, 1)};
}

std::vector<Light> light_faces(const Light& dome, bool own_samples) {
  PENUMBRA_ASSERT(dome.dome && dome.dome->face < 0, "light {} is no dome", dome.name);
  std::vector<Light> faces;
  for (std::size_t i = 0; i < kDomeFaces; ++i) {
    if (dome.dome->half && i == kDomeBottom) continue;
    const auto [middle, u, v] = dome_face(*dome.dome, i);
    Light& face = faces.emplace_back();
    face.name = dome.name;
    face.index = dome.index;
    face.kind = dome.kind;
    face.radiance = dome.radiance;
    face.center = face.center_u = face.center_v = middle;
    face.sun = Light::Directions{u, v, 1};
    face.dome = dome.dome;
    face.dome->face = static_cast<std::int32_t>(i);
    face.dome->half = dome.dome->half && is_side(i);
    face.area = face.dome->half ? 2 : 4;
    face.pattern = dome.pattern;
    if (own_samples) {
      constexpr int kSide = 8;
      const double low = face.dome->half ? 0 : -1;
      for (int k = 0; k < kSide * kSide; ++k) {
        const int row = k / kSide, column = k % kSide;
        const glm::dvec2 unit((column + 0.5) / kSide, (row + 0.5) / kSide);
        const glm::dvec2 st(2 * unit.x - 1, low + (1 - low) * unit.y);
        face.coordinates.push_back(st);
        face.points.push_back(glm::vec3(glm::dvec3(middle) + st.x * glm::dvec3(u) + st.y * glm::dvec3(v)) + 0.0f);
      }
      continue;
    }
    const auto from = static_cast<std::ptrdiff_t>(dome.dome->first[i]),
               to = static_cast<std::ptrdiff_t>(dome.dome->first[i + 1]);
    face.points.assign(dome.points.begin() + from, dome.points.begin() + to);
    face.coordinates.assign(dome.coordinates.begin() + from, dome.coordinates.begin() + to);
  }
  return faces;
}

double dome_form_factor(const Light& dome, const glm::dvec3& n) {
  if (!dome.dome->half) return 1;
  const glm::dvec3 up = glm::normalize(glm::cross(glm::dvec3(dome.dome->axes[0]), glm::dvec3(dome.dome->axes[1])));
  const glm::dvec3 sum = n + up;
  return glm::dot(sum, sum) / 4;
}

double dome_cosines(const Light& dome, std::span<const std::uint32_t> mask, const glm::vec3& n) {
  constexpr std::size_t kLanes = 8;  // partial sums, so that compilers vectorise the loop
  const glm::dvec3 normal(n);
  std::array<double, kLanes> sums{};
  const std::size_t count = dome.points.size();
  for (std::size_t first = 0; first < count; first += kLanes) {
    const std::uint32_t bits = mask.empty() ? 0xffU : mask[first / 32] >> first % 32 & 0xffU;
    if (bits == 0) continue;
    const std::size_t some = std::min(kLanes, count - first);
    for (std::size_t lane = 0; lane < some; ++lane) {
      const glm::vec3& d = dome.points[first + lane];
      const double cosine = normal.x * double{d.x} + normal.y * double{d.y} + normal.z * double{d.z};
      sums[lane] += (bits >> lane & 1U) != 0 ? std::max(0.0, cosine) : 0.0;
    }
  }
  double sum = 0;
  for (const double one : sums) sum += one;
  return sum;
}

float dome_share(const Light& dome, std::span<const std::uint32_t> mask, const glm::vec3& n) {
  const double all = dome_cosines(dome, {}, n);
  return all > 0 ? static_cast<float>(std::min(1.0, dome_cosines(dome, mask, n) / all)) : 0.0F;
}

}  // namespace penumbra::visibility
