// SPDX-License-Identifier: Apache-2.0
// Builds wedges of the construction of Assarsson and Akenine-Möller 2003 with one deliberate fault each, for tests of
// the validation.

#include "volumes/wedges/wedge_faults.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace penumbra::volumes {
namespace {

class Careless {
 public:
  Careless(const LightHull& light, Fault fault) : light_(light), fault_(fault) {}

  [[nodiscard]] std::vector<Plane> planes_of(const glm::dvec3& from, const glm::dvec3& to) const {
    const EdgeAndLight cast{from, to, light_.corners};
    glm::dvec3 a = from, b = to;
    if (fault_ != Fault::endpoint_not_moved) even(a, b);
    const glm::dvec3 edge = b - a;
    std::vector<Plane> planes;
    for (const double turn : {1.0, -1.0}) {
      const double toward = fault_ == Fault::front_back_swapped ? -1.0 : 1.0;
      add(planes, toward * tangent(a, edge, turn, false), a, cast);
    }
    for (const bool at_a : {true, false}) {
      const glm::dvec3 &end = at_a ? a : b, &other = at_a ? b : a;
      const glm::dvec3 along = glm::cross(edge, light_.center - end);
      const bool wrong = fault_ == Fault::wrong_light_vertex && at_a;
      const glm::dvec3 one = tangent(end, along, 1.0, wrong), two = tangent(end, along, -1.0, wrong);
      add(planes, glm::dot(one, other - end) > glm::dot(two, other - end) ? one : two, end, cast);
    }
    if (fault_ == Fault::near_plane_clipped) {
      const glm::dvec3 down = glm::normalize(0.5 * (a + b) - light_.center);
      planes.push_back({down.x, down.y, down.z, -glm::dot(down, from) - 0.01 * glm::length(from - light_.center)});
    }
    return planes;
  }

 private:
  void even(glm::dvec3& a, glm::dvec3& b) const {
    const double to_a = glm::length(a - light_.center), to_b = glm::length(b - light_.center);
    if (to_a > to_b) a = light_.center + (a - light_.center) * (to_b / to_a);
    if (to_b > to_a) b = light_.center + (b - light_.center) * (to_a / to_b);
  }

  /// Returns the unit normal of the plane that contains `at`, `direction` and a corner of the light: the outermost
  /// corner on one side, without checking for other corners beyond; with `wrong`, the innermost.
  [[nodiscard]] glm::dvec3 tangent(const glm::dvec3& at, const glm::dvec3& direction, double turn, bool wrong) const {
    glm::dvec3 best(0);
    for (const glm::dvec3& l : light_.corners) {
      const glm::dvec3 normal = turn * glm::cross(direction, l - at);
      const double beyond = glm::dot(best, l - at);
      if (best == glm::dvec3(0) || (wrong ? beyond < 0 : beyond > 0)) best = normal;
    }
    const double length = glm::length(best);
    return length > 0 ? best / length : glm::dvec3(0);
  }

  void add(std::vector<Plane>& planes, const glm::dvec3& normal, const glm::dvec3& at, const EdgeAndLight& cast) const {
    if (normal == glm::dvec3(0)) return;
    if (fault_ == Fault::rounded_inward) {
      const glm::vec3 n(normal);
      const auto d = static_cast<float>(-glm::dot(normal, at));
      planes.push_back({n.x, n.y, n.z, std::nextafter(d, -std::numeric_limits<float>::infinity())});
      return;
    }
    const auto inward = separating_direction(cast);
    const auto proved = inward ? bounding_plane(normal, cast, *inward, at) : std::nullopt;
    planes.push_back(proved ? *proved : Plane{normal.x, normal.y, normal.z, -glm::dot(normal, at)});
  }

  const LightHull& light_;
  Fault fault_;
};

std::vector<Wedge> without_splits(const std::vector<Wedge>& wedges, const Careless& careless) {
  std::vector<Wedge> whole;
  for (const Wedge& wedge : wedges) {
    if (wedge.parent) continue;
    whole.push_back(wedge);
    if (wedge.outcome != WedgeOutcome::split) continue;
    whole.back().outcome = WedgeOutcome::wedge;
    whole.back().planes = careless.planes_of(wedge.a, wedge.b);
  }
  return whole;
}

/// Makes the longest edge `split`, followed by one piece only.
std::vector<Wedge> half_forgotten(std::vector<Wedge> wedges) {
  const auto longest =
      std::ranges::max_element(wedges, {}, [](const Wedge& wedge) { return glm::length(wedge.b - wedge.a); });
  if (longest == wedges.end()) return wedges;
  Wedge half = *longest;
  half.b = 0.5 * half.a + 0.5 * half.b;
  half.parent = static_cast<std::uint32_t>(longest - wedges.begin());
  longest->outcome = WedgeOutcome::split;
  longest->planes.clear();
  wedges.insert(longest + 1, half);
  return wedges;
}

}  // namespace

std::vector<Wedge> build_faulty_wedges(std::span<const WedgeEdge> edges, const LightHull& light, Fault fault) {
  const Careless careless(light, fault);
  std::vector<Wedge> wedges = build_wedges(edges, light, Construction::original);
  if (fault == Fault::split_missing) {
    const bool any_split = std::ranges::find(wedges, WedgeOutcome::split, &Wedge::outcome) != wedges.end();
    return any_split ? without_splits(wedges, careless) : half_forgotten(std::move(wedges));
  }
  for (Wedge& wedge : wedges) {
    if (wedge.outcome == WedgeOutcome::wedge) wedge.planes = careless.planes_of(wedge.a, wedge.b);
  }
  return wedges;
}

}  // namespace penumbra::volumes
