#include "volumes/native_rows.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::volumes {
namespace {

double at_height(const RowEdge& edge, double y) {
  const double t = std::clamp((y - edge.y0) / (edge.y1 - edge.y0), 0.0, 1.0);
  return edge.x0 + t * (edge.x1 - edge.x0);
}

glm::dvec3 point(const WidePoints& points, std::size_t lane) {
  return {points[0][lane], points[1][lane], points[2][lane]};
}

/// p over the light's plane.
struct View {
  glm::dvec2 foot{0};  // from the light's corner, in cells
  double height = 0;

  /// Where a way (across, along, up) from p ends on the light.
  [[nodiscard]] glm::dvec2 appears(const glm::dvec3& way) const {
    return foot + height / way.z * glm::dvec2(way.x, way.y);
  }
};

/// The part of an edge that appears in a window of about twice the light, before any division. (bound window)
std::optional<std::pair<glm::dvec3, glm::dvec3>> cut_to_window(const Frame& frame, const View& view,
                                                               const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec2 middle(frame.half_cells), window = 2.0 * middle + 2.0;
  double from = 0, to = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double off = view.foot[axis] - middle[axis];
    const double xa = a[axis] * view.height + off * a.z, xb = b[axis] * view.height + off * b.z;
    for (const double sign : {-1.0, 1.0}) {
      const double inside_a = window[axis] * a.z + sign * xa, inside_b = window[axis] * b.z + sign * xb;
      if (inside_a < 0 && inside_b < 0) return std::nullopt;
      const double t = inside_a / (inside_a - inside_b);
      if (inside_a < 0) from = std::max(from, t);
      if (inside_b < 0) to = std::min(to, t);
    }
  }
  if (from > to) return std::nullopt;
  return std::pair(from > 0 ? glm::mix(a, b, from) : a, to < 1 ? glm::mix(a, b, to) : b);
}

}  // namespace

void RowSum::clear() {
  edges_.clear();
  left_.clear();
  at_corner_ = 0;
  corner_is_open_ = false;
}

/// Which side of one of the edge's triangles is p on? n is stored as a float: within what that rounds (16 · 2⁻²⁴ of
/// each term, bound side) exact predicates say it.
int RowSum::side_of(const WideEdges& leaf, std::size_t side, std::size_t lane, const Sample& at, Judge& judge) {
  const glm::dvec3 n = point(leaf.n[side], lane), from = glm::dvec3(at.p) - point(leaf.anchor[side], lane);
  const double f = glm::dot(n, from), error = 16 * static_cast<double>(kRound) * glm::dot(glm::abs(n), glm::abs(from));
  const double sure = std::abs(f) > error ? f : glm::dot(n, judge.normal_towards(at, leaf.plane[side][lane]));
  return sure > 0 ? 1 : sure < 0 ? -1 : 0;
}

bool RowSum::add(const WideEdges& leaf, std::size_t lane, const Sample& at, Judge& judge) {
  const glm::dvec3 p(at.p);
  int k = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    if (leaf.plane[side][lane] == at.plane) continue;  // its own plane hides nothing
    if (point(leaf.n[side], lane) != glm::dvec3(0)) k += side_of(leaf, side, lane, at, judge);
  }
  if (k == 0) return true;
  const auto way = [&](const WidePoints& end) {
    const glm::dvec3 d = point(end, lane) - p;
    return glm::dvec3(glm::dot(frame_.axes[0], d), glm::dot(frame_.axes[1], d), -glm::dot(frame_.axes[2], d));
  };
  const glm::dvec3 from_corner = p - frame_.corner;
  const View view{{glm::dot(frame_.axes[0], from_corner), glm::dot(frame_.axes[1], from_corner)},
                  glm::dot(frame_.axes[2], from_corner)};
  const glm::dvec3 a = way(leaf.a), b = way(leaf.b);
  const std::optional<std::pair<glm::dvec3, glm::dvec3>> part = cut_to_window(frame_, view, a, b);
  if (!part) return true;
  if (std::min(part->first.z, part->second.z) < 0x1p-45 * (glm::length(a) + glm::length(b))) return false;
  const glm::dvec2 from = view.appears(part->first), to = view.appears(part->second);
  add({from.x, from.y, to.x, to.y, frame_.side < 0 ? -k : k});
  return true;
}

void RowSum::add(RowEdge edge) {
  const double width = frame_.columns, height = frame_.rows;
  if (edge.y0 > edge.y1) edge = {edge.x1, edge.y1, edge.x0, edge.y0, -edge.k};
  if ((edge.x0 < 0) != (edge.x1 < 0)) {
    const double y = edge.y0 + (0 - edge.x0) / (edge.x1 - edge.x0) * (edge.y1 - edge.y0);
    if (std::abs(y) < 1e-7) corner_is_open_ = true;
    // Crossing it upwards, if it runs to the right: +k.
    if (y > 0 && y < height) left_.push_back({y, edge.x0 < edge.x1 ? edge.k : -edge.k});
  }
  // Cut to the light: first its sides, then top and bottom.
  for (const double side : {0.0, width}) {
    const bool out0 = side == 0 ? edge.x0 < 0 : edge.x0 > width, out1 = side == 0 ? edge.x1 < 0 : edge.x1 > width;
    if (out0 && out1) return;
    if (!out0 && !out1) continue;
    const double y = edge.y0 + (side - edge.x0) / (edge.x1 - edge.x0) * (edge.y1 - edge.y0);
    (out0 ? edge.x0 : edge.x1) = side;
    (out0 ? edge.y0 : edge.y1) = std::clamp(y, edge.y0, edge.y1);
  }
  if (edge.y1 <= 0 || edge.y0 >= height) return;
  const RowEdge whole = edge;
  if (edge.y0 < 0) {
    edge.x0 = at_height(whole, 0);
    edge.y0 = 0;
  }
  if (edge.y1 > height) {
    edge.x1 = at_height(whole, height);
    edge.y1 = height;
  }
  constexpr double kLevel = 1e-200;  // lower ones have no slope that a double holds, and no area
  if (edge.y1 - edge.y0 > kLevel) edges_.push_back(edge);
}

std::optional<std::int32_t> RowSum::relative_depth(const glm::dvec2& place) const {
  const auto [x, y] = std::pair(place.x, place.y);
  // More than what rounding the light point to float moves it by.
  const double near = std::max(1e-5, 8.0 * static_cast<double>(kRound * frame_.reach * frame_.per_length));
  std::int32_t depth = 0;
  for (const RowStep& step : left_) {
    if (std::abs(step.y - y) < near) return std::nullopt;
    if (step.y < y) depth += step.change;
  }
  for (const RowEdge& edge : edges_) {
    if (edge.y0 > y + near || edge.y1 < y - near) continue;
    if (std::abs(edge.y0 - y) < near || std::abs(edge.y1 - y) < near) return std::nullopt;
    const double crossing = at_height(edge, y);
    if (std::abs(crossing - x) < near) return std::nullopt;
    if (crossing < x) depth -= edge.k;
  }
  return depth;
}

void RowSum::add_horizon(const glm::dvec3& above) {
  const double width = frame_.columns, height = frame_.rows;
  // above · (s, t, 1) as a X + b Y + c, from the light's corner.
  const double a = 2 * above.x / width, b = 2 * above.y / height;
  const double c = above.z - above.x - above.y;
  const double low = c, high = b * height + c;  // at the ends of the light's left side
  if (a == 0 && b == 0) {
    at_corner_ = low > 0 ? 0 : 1;
    return;
  }
  const std::size_t before = left_.size();
  // Far beyond the light on either side, along the line.
  const double squared = a * a + b * b, foot = -(c + a * width / 2 + b * height / 2) / squared;
  const double x = width / 2 + a * foot, y = height / 2 + b * foot, far = 2 * (width + height) / std::sqrt(squared);
  const double sign = a > 0 ? 1 : -1;  // upward
  // To the right of it, where it runs upward, is above the plane if a > 0: one layer less.
  add({x + sign * b * far, y - sign * a * far, x - sign * b * far, y + sign * a * far, a > 0 ? 1 : -1});
  // At the end of the side that is farther from the line, so that a line through the corner is counted once.
  const std::int32_t change = left_.size() > before ? left_.back().change : 0;
  at_corner_ = std::abs(high) > std::abs(low) ? (high > 0 ? 0 : 1) - change : low > 0 ? 0 : 1;
}

std::optional<double> RowSum::visible_share(std::int32_t depth_at_corner, std::vector<Trapezoid>* parts) {
  const double width = frame_.columns, height = frame_.rows;
  if (parts != nullptr) parts->clear();
  const auto [visible, impossible] = sweep_({width, height, edges_, left_, depth_at_corner + at_corner_, parts});
  if (impossible > 1e-6 * width * height) return std::nullopt;
  return std::clamp(visible / (width * height), 0.0, 1.0);
}

float share_above_horizon(const Frame& frame, const glm::dvec3& above) {
  RowSum rows(frame);
  rows.clear();
  rows.add_horizon(above);
  return static_cast<float>(rows.visible_share(0, nullptr).value_or(0));
}

}  // namespace penumbra::volumes
