// SPDX-License-Identifier: Apache-2.0
// Outline of what hides a light from a point, drawn in the light's own coordinates s, t in [−1, 1]. Triangles are
// clipped as (s·height, t·height, height), before the division; a sphere or sun is the cone of directions from
// the point to it.

#include "app/view/light_outline.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

namespace penumbra::app {
namespace {

/// The light's plane as seen from the point: s = dot(q − p, s_axis) / height, t likewise, height = dot(q − p,
/// height_axis), which is 1 on the light. All three are linear in q, so that triangles are clipped before any division.
struct LightView {
  glm::dvec3 s_axis, t_axis, height_axis;
  double farthest = 1;  // largest height
  LightOutline::Rim rim = LightOutline::Rim::square;
};

/// Projects onto the plane through `center` with the half extents u and v; returns nullopt for a point in this plane,
/// or behind a light that emits to one side.
std::optional<LightView> view_of_plane(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v,
                                       const glm::dvec3& point, bool two_sided) {
  const glm::dvec3 normal = glm::cross(u, v), away = point - center;
  const double squared = glm::dot(normal, normal), side = glm::dot(away, normal);
  if (!(squared > 0) || (two_sided ? side == 0 : side <= 0)) return std::nullopt;
  LightView view;
  view.height_axis = normal / -side;
  // s and t are first relative to the point's foot in the plane, in units of u and v; then to the light's centre.
  const glm::dvec3 s = glm::cross(v, normal) / squared, t = glm::cross(normal, u) / squared;
  view.s_axis = s + glm::dot(away, s) * view.height_axis;
  view.t_axis = t + glm::dot(away, t) * view.height_axis;
  return view;
}

/// Projects onto a cone of directions about `axis` (unit) whose half angle has this tangent; surfaces farther than
/// `distance` are behind the light.
LightView view_of_cone(const glm::dvec3& axis, double tangent, double distance) {
  const glm::dvec3 aside = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(aside, axis)), v = glm::cross(axis, u);
  return {u / tangent, v / tangent, axis, distance, LightOutline::Rim::circle};
}

struct ViewOf {
  const glm::dvec3& point;
  bool two_sided;

  template <typename Halves>
  std::optional<LightView> halves(const Halves& shape) const {
    return view_of_plane(shape.center, shape.half_u, shape.half_v, point, two_sided);
  }
  std::optional<LightView> operator()(const scenes::Rectangle& shape) const { return halves(shape); }
  std::optional<LightView> operator()(const scenes::Ellipse& shape) const { return round(halves(shape)); }
  std::optional<LightView> operator()(const scenes::Disk& shape) const {
    const glm::dvec3 aside = std::abs(shape.normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = shape.radius * glm::normalize(glm::cross(aside, shape.normal));
    return round(view_of_plane(shape.center, u, glm::cross(shape.normal, u), point, two_sided));
  }
  std::optional<LightView> operator()(const scenes::Polygon& shape) const {
    const std::vector<glm::dvec3>& corners = shape.vertices;
    const glm::dvec3 u = glm::normalize(corners[1] - corners[0]);
    glm::dvec3 normal(0);
    for (std::size_t i = 0; i < corners.size(); ++i)
      normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    const glm::dvec3 v = glm::cross(glm::normalize(normal), u);
    glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
    for (const glm::dvec3& corner : corners) {
      const glm::dvec2 place(glm::dot(corner - corners[0], u), glm::dot(corner - corners[0], v));
      low = glm::min(low, place);
      high = glm::max(high, place);
    }
    const glm::dvec2 middle = 0.5 * (low + high), half = 0.5 * (high - low);
    auto view = view_of_plane(corners[0] + middle.x * u + middle.y * v, half.x * u, half.y * v, point, two_sided);
    if (view) view->rim = LightOutline::Rim::polygon;
    return view;
  }
  std::optional<LightView> operator()(const scenes::Sphere& shape) const {
    const glm::dvec3 to = shape.center - point;
    const double distance = glm::length(to);
    if (!(distance > shape.radius)) return std::nullopt;
    return view_of_cone(to / distance, std::tan(std::asin(shape.radius / distance)), distance);
  }
  std::optional<LightView> operator()(const scenes::Sun& shape) const {
    if (!(shape.angle > 0)) return std::nullopt;
    return view_of_cone(-shape.direction, std::tan(glm::radians(shape.angle / 2)), std::numeric_limits<double>::max());
  }
  std::optional<LightView> operator()(const scenes::Dome& /*shape*/) const { return std::nullopt; }
  std::optional<LightView> operator()(const scenes::Pieces& /*shape*/) const { return std::nullopt; }

 private:
  static std::optional<LightView> round(std::optional<LightView> view) {
    if (view) view->rim = LightOutline::Rim::circle;
    return view;
  }
};

/// Homogeneous coordinates (s · height, t · height, height).
using Flat = glm::dvec3;

/// Clips a convex polygon to dot(plane, q) ≥ least.
std::vector<Flat> part_above(const std::vector<Flat>& polygon, const Flat& plane, double least) {
  std::vector<Flat> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Flat &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double above_a = glm::dot(plane, a) - least, above_b = glm::dot(plane, b) - least;
    if (above_a >= 0) kept.push_back(a);
    if ((above_a >= 0) != (above_b >= 0)) kept.push_back(a + above_a / (above_a - above_b) * (b - a));
  }
  return kept;
}

/// Returns the part of a triangle that is in front of the light and not far outside its outline.
std::vector<glm::dvec2> blocker_of(std::vector<Flat> polygon, double farthest) {
  constexpr double kNearest = 1e-9, kBeside = 2;
  const std::array planes = {std::pair{Flat(0, 0, 1), kNearest * std::min(farthest, 1.0)},
                             std::pair{Flat(0, 0, -1), -farthest},
                             std::pair{Flat(1, 0, kBeside), 0.0},
                             std::pair{Flat(-1, 0, kBeside), 0.0},
                             std::pair{Flat(0, 1, kBeside), 0.0},
                             std::pair{Flat(0, -1, kBeside), 0.0}};
  for (const auto& [plane, least] : planes) {
    if (!polygon.empty()) polygon = part_above(polygon, plane, least);
  }
  glm::dvec2 low(kBeside), high(-kBeside);
  std::vector<glm::dvec2> places;
  for (const Flat& corner : polygon) {
    places.emplace_back(corner.x / corner.z, corner.y / corner.z);
    low = glm::min(low, places.back());
    high = glm::max(high, places.back());
  }
  if (places.size() < 3 || low.x > 1 || low.y > 1 || high.x < -1 || high.y < -1) return {};
  return places;
}

}  // namespace

std::optional<LightOutline> light_outline(const scenes::Scene& scene, const scenes::AreaLight& light,
                                          const OutlineFrom& from) {
  const std::optional<LightView> view = std::visit(ViewOf{from.point, light.two_sided}, light.shape);
  if (!view) return std::nullopt;
  const auto flat = [&](const glm::dvec3& position) {
    const glm::dvec3 q = position - from.point;
    return Flat(glm::dot(q, view->s_axis), glm::dot(q, view->t_axis), glm::dot(q, view->height_axis));
  };
  LightOutline outline;
  outline.rim = view->rim;
  if (const auto* polygon = std::get_if<scenes::Polygon>(&light.shape)) {
    for (const glm::dvec3& corner : polygon->vertices) {
      const Flat place = flat(corner);
      outline.corners.emplace_back(place.x / place.z, place.y / place.z);
    }
  }
  std::vector<char> hides(scene.objects.size());
  for (std::size_t i = 0; i < hides.size(); ++i) {
    const scenes::Object& object = scene.objects[i];
    const bool is_body = object.emits && scene.lights[*object.emits].name == light.name;
    hides[i] = static_cast<char>(object.casts_shadow && !is_body &&
                                 !std::ranges::binary_search(light.unshaded_by, static_cast<std::uint32_t>(i)));
  }
  for (std::size_t i = 0; i < scene.soup.triangles.size(); ++i) {
    if (i == from.triangle || hides[scene.soup.object[i]] == 0) continue;
    std::vector<Flat> corners;
    for (const std::uint32_t corner : scene.soup.triangles[i]) corners.push_back(flat(scene.soup.positions[corner]));
    std::vector<glm::dvec2> places = blocker_of(std::move(corners), view->farthest);
    if (places.empty()) continue;
    if (outline.blockers.size() == from.most) {
      outline.is_whole = false;
      break;
    }
    outline.blockers.push_back(std::move(places));
  }
  return outline;
}

nlohmann::ordered_json outline_json(const LightOutline& outline, const std::string& light) {
  constexpr std::array kRims = {"square", "circle", "polygon"};
  const auto listed = [](const std::vector<glm::dvec2>& places) {
    auto numbers = nlohmann::ordered_json::array();
    for (const glm::dvec2& place : places) {
      numbers.push_back(std::round(place.x * 1e4) / 1e4);
      numbers.push_back(std::round(place.y * 1e4) / 1e4);
    }
    return numbers;
  };
  auto blockers = nlohmann::ordered_json::array();
  for (const auto& blocker : outline.blockers) blockers.push_back(listed(blocker));
  return {{"light", light},
          {"rim", kRims.at(static_cast<std::size_t>(outline.rim))},
          {"corners", listed(outline.corners)},
          {"blockers", std::move(blockers)},
          {"whole", outline.is_whole}};
}

}  // namespace penumbra::app
