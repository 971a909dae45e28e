// SPDX-License-Identifier: Apache-2.0
// M. McCool, Shadow volume reconstruction from depth maps, ACM Transactions on Graphics 19 (1), 2000: edges of a shadow
// map become shadow volumes. Departures: an edge is where neither texel's surface, continued along its own slope, meets
// the other's, in place of a filter over the map; walls run along texels' borders, without the paper's templates that
// cut corners; the map's own border has walls, so that the eye may be outside. On the common border of two faces of a
// hemicube the depths are the same, so the walls of both faces cancel there.

#include "hybrids/map_volumes.hpp"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace penumbra::hybrids {
namespace {

using Place = std::array<std::int64_t, 2>;  // column and row

/// Inverse distances, in which planes are linear over the map; 0 where nothing is seen, and outside of the map.
class InverseDepths {
 public:
  InverseDepths(const DepthMap& map, double jump)
      : map_(map),
        tolerance_(jump * std::max(map.face.upper.x - map.face.lower.x, map.face.upper.y - map.face.lower.y) /
                   static_cast<double>(map.size)) {}

  [[nodiscard]] double at(const Place& place) const {
    const auto size = static_cast<std::int64_t>(map_.size);
    if (std::min(place[0], place[1]) < 0 || std::max(place[0], place[1]) >= size) return 0;
    const float depth = map_.depths[static_cast<std::size_t>(place[1] * size + place[0])];
    return depth < 1 ? 1 / (map_.far * static_cast<double>(depth)) : 0;
  }
  /// Returns the inverse distance of a texel's surface, continued by `steps` texels away from its neighbour `before`.
  [[nodiscard]] double continued(const Place& place, const Place& before, double steps) const {
    const double here = at(place), there = at(before);
    return there > 0 && are_near(here, there) ? here + steps * (here - there) : here;
  }
  /// Returns whether two neighbours show one surface.
  [[nodiscard]] bool are_joined(const Place& a, const Place& b) const {
    const double of_a = at(a), of_b = at(b);
    if (!(of_a > 0 && of_b > 0)) return of_a == of_b;
    const Place before_a{2 * a[0] - b[0], 2 * a[1] - b[1]}, before_b{2 * b[0] - a[0], 2 * b[1] - a[1]};
    const auto continues = [&](const Place& from, const Place& before, double to) {
      return at(before) > 0 && are_near(2 * at(from) - at(before), to);
    };
    return are_near(of_a, of_b) || continues(a, before_a, of_b) || continues(b, before_b, of_a);
  }

 private:
  /// Returns whether two distances differ by less than `jump` widths of a texel at that distance: Δz = jump · z · step,
  /// and Δ(1/z) = Δz / z².
  [[nodiscard]] bool are_near(double v, double w) const { return std::abs(v - w) <= tolerance_ * std::max(v, w); }

  const DepthMap& map_;
  double tolerance_;
};

glm::dvec3 direction(const DepthMap& map, double x, double y) {
  const glm::dvec2 at =
      map.face.lower + glm::dvec2(x, y) * (map.face.upper - map.face.lower) / static_cast<double>(map.size);
  return at.x * map.face.a + at.y * map.face.b + map.face.w;
}

}  // namespace

void add_walls(const DepthMap& map, double jump, volumes::LightVolumes& volumes) {
  const InverseDepths inverse(map, jump);
  const glm::dvec3 l(map.light);
  const auto add = [&](glm::dvec3 a, glm::dvec3 b, double at, std::int32_t multiplicity) {
    volumes.edges.push_back({glm::vec3(l + a / at), glm::vec3(l + b / at), multiplicity, 0, 0});
  };
  const auto border = [&](const Place& one, const Place& other) {
    if (inverse.are_joined(one, other)) return;
    const bool first = inverse.at(one) > inverse.at(other);
    const Place &near = first ? one : other, &far = first ? other : one;
    // The border's ends: the corners that both texels share.
    const auto x = static_cast<double>(std::max(one[0], other[0])), y = static_cast<double>(std::max(one[1], other[1]));
    glm::dvec3 a = direction(map, x, y);
    glm::dvec3 b = one[0] == other[0] ? direction(map, x + 1, y) : direction(map, x, y + 1);
    // Counter-clockwise around the nearer texel, as seen from l.
    const glm::dvec3 middle = direction(map, static_cast<double>(near[0]) + 0.5, static_cast<double>(near[1]) + 0.5);
    if (glm::determinant(glm::dmat3(a, b, middle)) > 0) std::swap(a, b);
    const auto at_border = [&](const Place& of, const Place& beyond) {
      return inverse.continued(of, {2 * of[0] - beyond[0], 2 * of[1] - beyond[1]}, 0.5);
    };
    const double begins = at_border(near, far), ends = inverse.at(far) > 0 ? at_border(far, near) : 0;
    if (!(begins > ends)) return;  // the continued surfaces meet between the texels
    add(a, b, begins, 1);
    if (ends > 0) add(a, b, ends, -1);
  };
  const auto size = static_cast<std::int64_t>(map.size);
  for (std::int64_t y = -1; y < size; ++y) {
    for (std::int64_t x = -1; x < size; ++x) {
      if (y >= 0) border({x, y}, {x + 1, y});
      if (x >= 0) border({x, y}, {x, y + 1});
    }
  }
}

bool is_behind(const DepthMap& map, const glm::dvec3& x) {
  const glm::dvec3 d = x - glm::dvec3(map.light);
  const double depth = glm::dot(d, map.face.w);
  if (!(depth > 0)) return false;
  const glm::dvec2 at(glm::dot(d, map.face.a) / depth, glm::dot(d, map.face.b) / depth);
  const glm::dvec2 place = glm::floor((at - map.face.lower) / (map.face.upper - map.face.lower) * double(map.size));
  if (std::min(place.x, place.y) < 0 || std::max(place.x, place.y) >= map.size) return false;
  const float seen = map.depths[static_cast<std::size_t>(place.y) * map.size + static_cast<std::size_t>(place.x)];
  return seen < 1 && depth > map.far * static_cast<double>(seen);
}

}  // namespace penumbra::hybrids
