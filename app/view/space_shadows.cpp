// SPDX-License-Identifier: Apache-2.0
// Silhouettes, shadow volumes and penumbra wedges of a light as a message of the 3D view.

#include "app/view/space_shadows.hpp"

#include "app/view/space_message.hpp"
#include "mesh/silhouettes.hpp"
#include "volumes/wedges/wedge_body.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace penumbra::app {
namespace {

using nlohmann::ordered_json;
using Segment = std::array<glm::dvec3, 2>;

/// Floats of points, three a point.
class Points {
 public:
  void add(const glm::dvec3& point) {
    for (int k = 0; k < 3; ++k) floats_.push_back(static_cast<float>(point[k]));
  }
  [[nodiscard]] const std::vector<float>& floats() const { return floats_; }

 private:
  std::vector<float> floats_;
};

/// Returns the part of a convex polygon where coordinate k, times `direction`, is at most `most`.
std::vector<glm::dvec3> part_below(const std::vector<glm::dvec3>& polygon, int k, double direction, double most) {
  std::vector<glm::dvec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = direction * a[k] - most, over_b = direction * b[k] - most;
    if (over_a <= 0) kept.push_back(a);
    if ((over_a <= 0) != (over_b <= 0)) {
      kept.push_back(a + over_a / (over_a - over_b) * (b - a));
      kept.back()[k] = direction * most;  // exactly on the boundary, despite rounding
    }
  }
  return kept;
}

/// Returns a point on the ray from `l` through `end`, beyond `end` and outside the box.
glm::dvec3 far_behind(const glm::dvec3& end, const glm::dvec3& l, const volumes::Box& box) {
  const glm::dvec3 direction = end - l;
  return end + 2 * glm::length(box.upper - box.lower) / glm::length(direction) * direction;
}

glm::dvec3 pulled_inside(const glm::dvec3& point, const glm::dvec3& center, const std::vector<glm::dvec3>& corners) {
  glm::dvec3 normal(0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(corners[i] - center, corners[(i + 1) % corners.size()] - center);
  double share = 1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 inward = glm::cross(normal, corners[(i + 1) % corners.size()] - corners[i]);
    const double own = glm::dot(inward, center - corners[i]), moved = glm::dot(inward, point - center);
    if (own + moved < 0) share = std::min(share, own / -moved);
  }
  return center + share * (point - center);
}

/// Adds the silhouettes from the point, and the sides of the shadow volume.
void add_silhouettes(SpaceMessage& message, ordered_json& header, const volumes::Casters& casters,
                     const glm::dvec3& point, const volumes::Box& box, double floor) {
  Points edges, sides, lines;
  std::vector<std::uint32_t> numbers, side_triangles;
  std::vector<std::int32_t> multiplicities;
  for (const auto& [edge, multiplicity] : mesh::silhouette_edges(casters.view(), casters.graph, point)) {
    const Segment ends = {casters.positions[casters.graph.edges[edge].a],
                          casters.positions[casters.graph.edges[edge].b]};
    for (const glm::dvec3& end : ends) edges.add(end);
    numbers.push_back(edge);
    multiplicities.push_back(multiplicity);
    if (numbers.size() > kMostShownSides) continue;
    const std::vector<glm::dvec3> side = volume_side(ends, point, box);
    for (std::size_t i = 1; i + 1 < side.size(); ++i) {
      for (const std::size_t corner : {std::size_t{0}, i, i + 1}) sides.add(side[corner]);
    }
    side_triangles.push_back(static_cast<std::uint32_t>(side.size() < 3 ? 0 : side.size() - 2));
    const auto line = side_at(ends, point, box, floor);
    if (line) {
      for (const glm::dvec3& end : *line) lines.add(end);
    }
  }
  message.add("silhouettes", edges.floats());
  message.add("silhouetteEdges", numbers);
  message.add("multiplicities", multiplicities);
  message.add("sides", sides.floats());
  message.add("sideTriangles", side_triangles);
  message.add("shadowLines", lines.floats());
  header["silhouettes"] = numbers.size();
  header["sides"] = side_triangles.size();
}

/// Adds the bodies of the requested wedges, and the lines in which the floor cuts them.
void add_bodies(SpaceMessage& message, ordered_json& header, const session::LightWedges& made, const volumes::Box& box,
                const SpaceShadows& request, double floor) {
  std::vector<std::uint32_t> numbers;
  std::size_t with_body = 0;
  for (std::uint32_t i = 0; i < made.wedges.size(); ++i) {
    if (made.wedges[i].outcome != volumes::WedgeOutcome::wedge) continue;
    ++with_body;
    if (request.wedge ? *request.wedge == i : numbers.size() < kMostShownBodies) numbers.push_back(i);
  }
  std::vector<volumes::WedgeBody> bodies(numbers.size());
  tbb::parallel_for(std::size_t{0}, numbers.size(),
                    [&](std::size_t i) { bodies[i] = volumes::wedge_body(made.wedges[numbers[i]], box); });
  Points triangles, lines, floor_lines;
  std::vector<std::uint32_t> counts;  // for each body: wedge, triangles, lines, lines on the floor
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const volumes::WedgeBody& body = bodies[i];
    for (const mesh::Triangle& triangle : body.triangles) {
      for (const std::uint32_t corner : triangle) triangles.add(body.corners[corner]);
    }
    for (const auto& edge : body.edges) {
      for (const std::uint32_t corner : edge) lines.add(body.corners[corner]);
    }
    const std::vector<glm::dvec3> cut = volumes::section_at(body, floor);
    for (std::size_t k = 0; k < cut.size(); ++k) {
      floor_lines.add(cut[k]);
      floor_lines.add(cut[(k + 1) % cut.size()]);
    }
    for (const std::size_t count : {std::size_t{numbers[i]}, body.triangles.size(), body.edges.size(), cut.size()})
      counts.push_back(static_cast<std::uint32_t>(count));
  }
  message.add("bodies", counts);
  message.add("bodyTriangles", triangles.floats());
  message.add("bodyLines", lines.floats());
  message.add("floorLines", floor_lines.floats());
  header["bodies"] = bodies.size();
  header["leftOut"] = request.wedge ? 0 : with_body - bodies.size();
}

void add_wedges(SpaceMessage& message, ordered_json& header, const session::LightWedges& made) {
  Points edges;
  std::vector<std::uint32_t> sources, outcomes;
  std::map<std::string, std::size_t> counts;
  for (const volumes::Wedge& wedge : made.wedges) {
    edges.add(wedge.a);
    edges.add(wedge.b);
    sources.push_back(made.casting.edges[wedge.source]);
    outcomes.push_back(static_cast<std::uint32_t>(wedge.outcome));
    ++counts[volumes::name_of(wedge.outcome)];
  }
  message.add("wedgeEdges", edges.floats());
  message.add("wedgeSources", sources);
  message.add("outcomes", outcomes);
  header["wedges"] = made.wedges.size();
  header["outcomes"] = counts;
}

/// Names the wedges that contain the point, as `wedges --explain` counts them.
void name_wedges(ordered_json& header, const std::vector<volumes::Wedge>& wedges, const glm::dvec3& point) {
  auto named = ordered_json::array();
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < wedges.size(); ++i) {
    const volumes::WedgeOutcome outcome = wedges[i].outcome;
    if (outcome == volumes::WedgeOutcome::split || outcome == volumes::WedgeOutcome::empty) continue;
    if (!volumes::is_inside(wedges[i], point)) continue;
    if (++count <= kMostNamedWedges) named.push_back(i);
  }
  header["inside"] = {{"count", count}, {"wedges", std::move(named)}};
}

}  // namespace

glm::dvec3 light_point(const visibility::Light& light, const glm::dvec2& place) {
  const glm::dvec3 center(visibility::center_of(light));
  const bool is_circle = visibility::is_round(light.kind);
  const glm::dvec2 at = is_circle && glm::length(place) > 1 ? glm::normalize(place) : place;
  if (visibility::is_body(light.kind)) return center + light.radius * glm::dvec3(at.x, 0, at.y);
  if (is_circle || visibility::is_parallelogram(light.kind)) {
    const visibility::LightFrame frame = visibility::light_frame(light);
    return frame.center + at.x * frame.u + at.y * frame.v;
  }
  const std::vector<glm::dvec3> corners(light.outline.begin(), light.outline.end());
  const glm::dvec3 u = glm::normalize(corners[1] - corners[0]);
  glm::dvec3 normal(0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(corners[i] - center, corners[(i + 1) % corners.size()] - center);
  const glm::dvec3 v = glm::cross(glm::normalize(normal), u);
  glm::dvec2 reach(0);
  for (const glm::dvec3& corner : corners)
    reach = glm::max(reach, glm::abs(glm::dvec2(glm::dot(corner - center, u), glm::dot(corner - center, v))));
  return pulled_inside(center + at.x * reach.x * u + at.y * reach.y * v, center, corners);
}

std::vector<glm::dvec3> volume_side(const Segment& edge, const glm::dvec3& l, const volumes::Box& box) {
  const auto& [a, b] = edge;
  if (!(glm::length(glm::cross(a - l, b - l)) > 0)) return {};
  std::vector<glm::dvec3> polygon = {a, b, far_behind(b, l, box), far_behind(a, l, box)};
  for (int k = 0; k < 3; ++k) {
    polygon = part_below(polygon, k, 1, box.upper[k]);
    polygon = part_below(polygon, k, -1, -box.lower[k]);
  }
  return polygon;
}

std::optional<Segment> side_at(const Segment& edge, const glm::dvec3& l, const volumes::Box& box, double height) {
  const auto& [a, b] = edge;
  if (!(glm::length(glm::cross(a - l, b - l)) > 0)) return std::nullopt;
  const std::array<glm::dvec3, 4> corners = {a, b, far_behind(b, l, box), far_behind(a, l, box)};
  std::vector<glm::dvec3> met;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 &from = corners[i], &to = corners[(i + 1) % corners.size()];
    if (from.y == height) met.push_back(from);
    if (from.y == height || to.y == height || (from.y < height) == (to.y < height)) continue;
    met.push_back(from + (height - from.y) / (to.y - from.y) * (to - from));
    met.back().y = height;
  }
  if (met.size() != 2) return std::nullopt;
  for (const int k : {0, 2}) {
    met = part_below(met, k, 1, box.upper[k]);
    met = part_below(met, k, -1, -box.lower[k]);
    if (met.size() < 2) return std::nullopt;
  }
  return Segment{met[0], met[1]};
}

std::string shadows_message(const volumes::Casters& casters, const visibility::Light& light, const glm::dvec3& origin,
                            const SpaceShadows& request) {
  ordered_json header = {{"light", light.name}};
  SpaceMessage message;
  const session::LightWedges made = session::wedges_of(casters, light, request.wedges);
  const volumes::Box box = volumes::bounds_of(casters);
  const double floor = request.floor ? *request.floor - origin.y : box.lower.y;
  const glm::dvec3 point = light_point(light, request.place), shown = origin + point;
  header["point"] = {shown.x, shown.y, shown.z};
  header["floor"] = origin.y + floor;
  Points hull;
  for (const mesh::Triangle& triangle : volumes::hull_triangles(made.hull)) {
    for (const std::uint32_t corner : triangle) hull.add(made.hull.corners[corner]);
  }
  message.add("hull", hull.floats());
  add_silhouettes(message, header, casters, point, box, floor);
  add_wedges(message, header, made);
  add_bodies(message, header, made, box, request, floor);
  if (request.point) name_wedges(header, made.wedges, *request.point);
  if (!light.filtered_by.empty()) header["filteredBy"] = light.filtered_by;
  return message.finish(header);
}

}  // namespace penumbra::app
