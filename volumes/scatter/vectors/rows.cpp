// SPDX-License-Identifier: Apache-2.0
// rows=exact of edge scatter: places edges for one view sample in double with error bounds, and proves the visible
// fraction of the light. docs/edge-scatter.md, "Without light samples" and "What double proves".

#include "volumes/scatter/vectors/rows.hpp"

#include "engines/vectors/disk_plane.hpp"
#include "mesh/predicates.hpp"
#include "volumes/edges/plane_normal.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace penumbra::volumes {
namespace {

constexpr double kUnit = 0x1p-53;  // half a unit in the last place of 1

double at_height(const RowEdge& edge, double y) {
  const double t = std::clamp((y - edge.y0) / (edge.y1 - edge.y0), 0.0, 1.0);
  return edge.x0 + t * (edge.x1 - edge.x0);
}

glm::dvec3 point(const WidePoints& points, std::size_t lane) {
  return {points[0][lane], points[1][lane], points[2][lane]};
}

/// Returns whether the light's corner is within `error` of the edge.
bool passes_corner(const RowEdge& edge, double error) {
  const auto holds = [&](double a, double b) { return std::min(a, b) <= error && std::max(a, b) >= -error; };
  if (!holds(edge.x0, edge.x1) || !holds(edge.y0, edge.y1)) return false;
  const double beside = std::abs(edge.x0 * edge.y1 - edge.x1 * edge.y0);
  return beside <= error * (std::abs(edge.x1 - edge.x0) + std::abs(edge.y1 - edge.y0));
}

}  // namespace

/// A corner of the outline is projected orthogonally onto the plane, as p is. (bound foot)
LightRegion make_light_region(const visibility::Light& light, const LightWindow& window, const LightGrid& grid,
                              float scale) {
  const glm::dvec2 cells(grid.columns, grid.rows);
  LightRegion region{window, LightMeasure(light, cells)};
  if (light.dome && light.dome->half) {
    region.upper_half = true;
    region.measure.set_whole(cells.x * cells.y / 2);
  }
  if (!is_polygon(light.kind)) return region;
  const double per_length = std::max(glm::length(grid.axes[0]), glm::length(grid.axes[1]));
  double farthest = 0, twice_area = 0;
  std::vector<glm::dvec2> corners;
  for (const glm::vec3& corner : light.outline) {
    const glm::dvec3 from = glm::dvec3(corner * scale) - grid.corner;
    corners.emplace_back(glm::dot(grid.axes[0], from), glm::dot(grid.axes[1], from));
    farthest = std::max(farthest, glm::length(from));
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    twice_area += a.x * b.y - a.y * b.x;
    region.outline.push_back({a.x, a.y, b.x, b.y, 0});
  }
  // The light is left of each edge of a counter-clockwise outline; to the right of the edge there is one more layer.
  for (RowEdge& edge : region.outline) edge.k = twice_area > 0 ? -1 : 1;
  region.measure.set_whole(std::abs(twice_area) / 2);
  region.outline_error =
      2 * per_length *
      (32 * kUnit * static_cast<double>(grid.skew) * farthest + 8 * kUnit * static_cast<double>(grid.reach));
  const glm::dvec2 size = window.size();
  region.rounding = 1 + std::abs(window.shear) * std::max(std::abs(window.low.y), std::abs(window.high.y)) / size.x;
  return region;
}

RowSum::RowSum(const LightGrid& grid, const LightRegion& region, const visibility::SceneFloats& scene, float scale)
    : grid_(grid),
      region_(region),
      scene_(scene),
      scale_(scale),
      axes_(grid.axes),
      per_length_(std::max(glm::length(grid.axes[0]), glm::length(grid.axes[1]))),
      skew_(grid.skew) {}

/// Error of the foot: (bound foot).
void RowSum::set_view_sample(const GridSample& at) {
  edges_.clear();
  left_.clear();
  at_corner_ = 0;
  error_ = largest_error_ = 0;
  corner_is_open_ = is_open_ = cuts_at_disk_ = false;
  p_ = glm::dvec3(at.p);
  plane_ = at.plane;
  if (grid_.cones) return see_cone(grid_.cones->of[at.cone]);
  const glm::dvec3 from = p_ - grid_.corner;
  foot_ = {glm::dot(grid_.axes[0], from), glm::dot(grid_.axes[1], from)};
  height_ = glm::dot(grid_.axes[2], from);
  const double away = glm::length(from), off = 8 * kUnit * static_cast<double>(grid_.reach);
  error_foot_ = per_length_ * (32 * kUnit * skew_ * away + off);
  error_height_ = 16 * kUnit * skew_ * away + off;
  steepness_ = height_ / (away + 2 * static_cast<double>(grid_.radius));
  is_open_ = !(height_ > 8 * error_height_);
}

/// A direction is λ (middle + s u + t v). λ, s and t are computed by determinants, since a sun's axes are floats and
/// not exactly orthogonal. The error of `middle` moves places as the error of a foot does. (bound foot)
void RowSum::see_cone(const LightCone& cone) {
  const auto& [m, u, v] = cone;
  const glm::dvec3 n = glm::cross(u, v);
  const double volume = glm::dot(m, n);
  height_ = glm::length(m);
  axes_ = {static_cast<double>(grid_.half_cells.x) / volume * glm::cross(v, m),
           static_cast<double>(grid_.half_cells.y) / volume * glm::cross(m, u), -height_ / volume * n};
  per_length_ = std::max(glm::length(axes_[0]), glm::length(axes_[1]));
  skew_ = 4;
  foot_ = glm::dvec2(grid_.half_cells);
  const double off = grid_.cones->end ? 8 * kUnit * static_cast<double>(grid_.reach) : 8 * kUnit;
  error_foot_ = per_length_ * off;
  error_height_ = off;
  steepness_ = height_ / glm::length(cone.corner());
  is_open_ = !(height_ > 8 * error_height_);
}

/// Returns the side of one of the edge's triangles that p is on. n is the exact normal rounded to float; where that
/// rounding matters (16 · 2⁻²⁴ of each term, bound side), exact predicates decide.
int RowSum::side_of(const WideEdges& leaf, std::size_t side, std::size_t lane) const {
  const glm::dvec3 n = point(leaf.n[side], lane), from = p_ - point(leaf.anchor[side], lane);
  const double f = glm::dot(n, from), error = 16 * static_cast<double>(kRound) * glm::dot(glm::abs(n), glm::abs(from));
  if (std::abs(f) > error) return f > 0 ? 1 : -1;
  const auto corners = scene_.corners(leaf.plane[side][lane]);  // a plane's index is that of a triangle in it
  const glm::dvec3 unscaled = p_ / static_cast<double>(scale_);
  const auto at = mesh::side_of_plane(glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2]), unscaled);
  if (at == mesh::Side::on) return 0;
  // Both normals have the signs of the exact ones, which are parallel: so all terms of their product have the same
  // sign.
  const bool alike = glm::dot(n, glm::dvec3(rounded_normal(corners))) > 0;
  return alike == (at == mesh::Side::front) ? 1 : -1;
}

int RowSum::multiplicity(const WideEdges& leaf, std::size_t lane) const {
  int k = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    if (leaf.plane[side][lane] == plane_) continue;  // the view sample's own plane hides nothing
    if (point(leaf.n[side], lane) == glm::dvec3(0)) continue;
    k += side_of(leaf, side, lane);
  }
  return k;
}

/// Returns the vector to a point, with its error (bound way).
RowSum::Direction RowSum::direction_to(const glm::dvec3& point) const {
  const glm::dvec3 d = point - p_;
  const double length = std::abs(d.x) + std::abs(d.y) + std::abs(d.z), error = kUnit * skew_ * length;
  return {{glm::dot(axes_[0], d), glm::dot(axes_[1], d), -glm::dot(axes_[2], d)},
          64 * error * per_length_,
          32 * error,
          length};
}

RowSum::Direction RowSum::direction_to(const CutEnd& end) const {
  if (!end.place) {
    Direction direction = direction_to(end.point);  // computed from points within `reach`
    const double off = 16 * kUnit * static_cast<double>(grid_.reach);
    direction.error += off * per_length_;
    direction.error_up += off;
    return direction;
  }
  const glm::dvec2 place = *end.place * 2.0 * glm::dvec2(grid_.half_cells), to = place - foot_;
  const double size = std::abs(place.x) + std::abs(place.y);
  return {{to.x, to.y, height_},
          error_foot_ + 4 * kUnit * (size + std::abs(foot_.x) + std::abs(foot_.y)),
          error_height_,
          height_ / steepness_ * (1 + size)};
}

RowSum::Directions RowSum::directions_of(const WideEdges& leaf, std::size_t lane, const CutEnds* ends) const {
  const std::uint32_t cut = leaf.cut[lane];
  if (cut == 0 || ends == nullptr) {
    const glm::dvec3 a = point(leaf.a, lane), b = point(leaf.b, lane);
    return {direction_to(a), direction_to(b), vectors::comes_first(b, a)};
  }
  const CutEnds::Edge& edge = (*ends)[cut];
  return {direction_to(edge.a), direction_to(edge.b)};
}

/// Returns a bound of the rounding error, in double, of how far a vector's end is inside a side of the window.
double RowSum::error_inside(const Direction& direction, int axis) const {
  const double middle = static_cast<double>(grid_.half_cells[axis]), window = 2 * middle + 2;
  return 2 * (height_ * direction.error + (window + std::abs(foot_[axis] - middle)) * direction.error_up +
              error_height_ * std::abs(direction.to[axis]) + error_foot_ * std::abs(direction.to.z));
}

/// Returns whether an edge that was clipped away completely might still pass through p within rounding. If the edge is
/// not that close to p, then every part of it on the light is so high above p that no error can have removed it. (bound
/// apex)
bool RowSum::may_pass_p(const Directions& directions) const {
  const Direction &a = directions.a, &b = directions.b;
  const double error = std::max({error_inside(a, 0), error_inside(a, 1), error_inside(b, 0), error_inside(b, 1)});
  const glm::dvec2 lengths = glm::dvec2(1 / per_length_);
  const glm::dvec3 near_a(glm::dvec2(a.to) * lengths, a.to.z), near_b(glm::dvec2(b.to) * lengths, b.to.z);
  const double nearest = glm::length(glm::cross(near_a, near_b)) / std::max(a.length + b.length, 0x1p-300);
  return !(nearest * steepness_ * static_cast<double>(std::min(grid_.half_cells.x, grid_.half_cells.y)) > 4 * error);
}

/// Clips an edge to a window of about twice the light, before any division. (bound window) Returns false if no part of
/// it is on the light.
bool RowSum::cut_to_window(Directions& directions) {
  Direction &a = directions.a, &b = directions.b;
  const glm::dvec2 middle(grid_.half_cells), window = 2.0 * middle + 2.0;
  double from = 0, to = 1;
  const auto cut = [&](double inside_a, double inside_b) {
    const double t = inside_a / (inside_a - inside_b);
    if (inside_a < 0) from = std::max(from, t);
    if (inside_b < 0) to = std::min(to, t);
    return t;
  };
  for (int axis = 0; axis < 2; ++axis) {
    const double off = foot_[axis] - middle[axis];
    const double xa = a.to[axis] * height_ + off * a.to.z, xb = b.to[axis] * height_ + off * b.to.z;
    for (const double sign : {-1.0, 1.0}) {
      const double inside_a = window[axis] * a.to.z + sign * xa, inside_b = window[axis] * b.to.z + sign * xb;
      if (inside_a < 0 && inside_b < 0) {
        // The window is larger than the light: a part wrongly taken to be outside passes p, or is not on the light.
        const bool certain = inside_a <= -error_inside(a, axis) && inside_b <= -error_inside(b, axis);
        is_open_ = is_open_ || (!certain && may_pass_p(directions));
        return false;
      }
      cut(inside_a, inside_b);
    }
  }
  bool starts_at_disk = false, ends_at_disk = false;
  if (grid_.cones && grid_.cones->end) {  // (bound ends)
    const int side_a = cuts_at_disk_ ? side_of_disk(a) : 0, side_b = cuts_at_disk_ ? side_of_disk(b) : 0;
    directions.is_unsure = cuts_at_disk_ && side_a * side_b == 0;
    if (!directions.is_unsure) {
      if (a.to.z > height_ && b.to.z > height_) return false;
      const double there = cut(height_ - a.to.z, height_ - b.to.z);
      starts_at_disk = side_a > 0 && from == there;
      ends_at_disk = side_b > 0 && to == there;
    }
  }
  if (from > to) {
    is_open_ = is_open_ || may_pass_p(directions);
    return false;
  }
  if (from == 0 && to == 1) return true;
  const glm::dvec3 start = from > 0 ? glm::mix(a.to, b.to, from) : a.to, end = to < 1 ? glm::mix(a.to, b.to, to) : b.to;
  if (starts_at_disk || ends_at_disk) (starts_at_disk ? a : b) = directions.b_first ? pass_disk(b, a) : pass_disk(a, b);
  if (!starts_at_disk) a.to = start;
  if (!ends_at_disk) b.to = end;
  return true;
}

/// Returns the error of the place of an edge's ends, given their errors sideways and upward. The lower end's height
/// over p is the light's divided by `stretch`; places are at most `far` from the foot. (bound place)
double RowSum::placing_error(double stretch, double error, double error_up, double far) const {
  return 2 * (error_foot_ + stretch * error + far * ((error_height_ + stretch * error_up) / height_ + 8 * kUnit) +
              8 * kUnit * (std::abs(foot_.x) + std::abs(foot_.y)));
}

std::optional<RowSum::Placed> RowSum::place(const WideEdges& leaf, std::size_t lane, const CutEnds* ends,
                                            std::optional<int> known) {
  const int from_front = known ? *known : multiplicity(leaf, lane), k = grid_.side < 0 ? -from_front : from_front;
  if (k == 0 || is_open_) return std::nullopt;
  Directions directions = directions_of(leaf, lane, ends);
  if (!cut_to_window(directions)) return std::nullopt;
  const Direction &a = directions.a, &b = directions.b;
  const double lowest = std::min(a.to.z, b.to.z), error = std::max(a.error, b.error),
               error_up = std::max(a.error_up, b.error_up);
  if (!(lowest > 8 * error_up)) {  // the edge passes through p within rounding
    is_open_ = true;
    return std::nullopt;
  }
  const double stretch_a = height_ / a.to.z, stretch_b = height_ / b.to.z;
  const glm::dvec2 place_a = stretch_a * glm::dvec2(a.to), place_b = stretch_b * glm::dvec2(b.to);
  const double far = std::max(std::abs(place_a.x) + std::abs(place_a.y), std::abs(place_b.x) + std::abs(place_b.y));
  const glm::dvec2 from = foot_ + place_a, to = foot_ + place_b;
  const Placed placed{{from.x, from.y, to.x, to.y, k},
                      placing_error(std::max(stretch_a, stretch_b), error, error_up, far)};
  if (!directions.is_unsure) return placed;
  is_open_ = is_open_ || !passes_by(placed.edge, kUnsure * placed.error);
  return std::nullopt;
}

/// Adds an error, rounded up to a multiple of 2⁻⁵²: sums of these up to 2 are exact, in any order.
void RowSum::count_error(double error) {
  error_ += std::ceil(error * 0x1p52) * 0x1p-52;
  largest_error_ = std::max(largest_error_, error);
}

/// Drops edges no higher than kLevel. Their slope can exceed 2¹³ (columns) times the inverse of this height, and
/// products with it overflow; without the edge, areas change by less than columns times this height.
void RowSum::keep(const RowEdge& edge) {
  constexpr double kLevel = 0x1p-900;
  if (edge.y1 - edge.y0 > kLevel) edges_.push_back(edge);
}

/// Returns whether the edge is outside of the light, even with its error.
bool RowSum::is_beside(const RowEdge& edge, double error) const {
  const auto beside = [&](double from, double to, double size) {
    return std::max(from, to) < -2 * error || std::min(from, to) > size + 2 * error;
  };
  return beside(edge.x0, edge.x1, grid_.columns) || beside(edge.y0, edge.y1, grid_.rows);
}

/// Returns whether no part of the edge is on the light, even with its error: it is outside, or the light is on one side
/// of it.
bool RowSum::passes_by(const RowEdge& edge, double error) const {
  const double width = grid_.columns, height = grid_.rows, along_x = edge.x1 - edge.x0, along_y = edge.y1 - edge.y0;
  const auto side = [&](double x, double y) { return along_x * (y - edge.y0) - along_y * (x - edge.x0); };
  const auto [least, most] = std::minmax({side(0, 0), side(width, 0), side(0, height), side(width, height)});
  const double off = 2 * error * (std::abs(along_x) + std::abs(along_y));
  return is_beside(edge, error) || least > off || most < -off;
}

/// Adds an edge. `error`: error of its ends' places. Edges outside of the light are ignored, since not every hierarchy
/// lists them: the result must not depend on the hierarchy.
void RowSum::add(RowEdge edge, double error) {
  if (is_beside(edge, error)) return;
  if (!(error < 0.5)) {
    is_open_ = true;
    return;
  }
  count_error(error);
  if (passes_corner(edge, 2 * error)) corner_is_open_ = true;
  const double width = grid_.columns, height = grid_.rows;
  if (edge.y0 > edge.y1) edge = {edge.x1, edge.y1, edge.x0, edge.y0, -edge.k};
  if ((edge.x0 < 0) != (edge.x1 < 0)) {
    const double y = edge.y0 + (0 - edge.x0) / (edge.x1 - edge.x0) * (edge.y1 - edge.y0);
    // Change of the depth above the crossing: +k if the edge runs to the right.
    if (y > 0 && y < height) left_.push_back({y, edge.x0 < edge.x1 ? edge.k : -edge.k});
  }
  // Clips the edge to the light: first at its sides, then at top and bottom.
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
  keep(edge);
}

std::optional<std::int32_t> RowSum::relative_depth(const glm::dvec2& place, double off) const {
  const auto [x, y] = std::pair(place.x, place.y);
  // True edges are at least half of this away; the rounding that follows does not exceed the other half.
  const double near = off + 4 * largest_error_ + 64 * kUnit * region_.rounding * (grid_.columns + grid_.rows);
  std::int32_t depth = 0;
  for (const RowStep& step : left_) {
    if (std::abs(step.y - y) < near) return std::nullopt;
    if (step.y < y) depth += step.change;
  }
  for (const RowEdge& edge : edges_) {
    if (edge.y0 > y + near || edge.y1 < y - near) continue;
    if (std::abs(edge.y0 - y) < near || std::abs(edge.y1 - y) < near) return std::nullopt;
    const double crossing = at_height(edge, y), slope = std::abs(edge.x1 - edge.x0) / (edge.y1 - edge.y0);
    if (std::abs(crossing - x) < near * (1 + slope)) return std::nullopt;
    if (crossing < x) depth -= edge.k;
  }
  return depth;
}

void RowSum::add_horizon(const HorizonLine& line) {
  at_corner_ = 0;
  add_line(line);
  if (region_.upper_half) add_line({{0, 1, 0}, glm::dvec3(0)});
}

/// The part of the light below the line has one more layer.
void RowSum::add_line(const HorizonLine& line) {
  const double width = grid_.columns, height = grid_.rows;
  // The line's expression above · (s, t, 1) as a X + b Y + c, with X and Y from the window's corner.
  const LightWindow& window = region_.window;
  const glm::dvec2 size = window.size();
  const glm::dvec3& above = line.above;
  const double a = above.x * size.x / width, b = (above.y - window.shear * above.x) * size.y / height;
  const double c = above.z + above.x * window.low.x + (above.y - window.shear * above.x) * window.low.y;
  const double low = c, high = b * height + c;  // at the ends of the light's left side
  const double t = std::max(std::abs(window.low.y), std::abs(window.high.y)),
               s = std::max(std::abs(window.low.x), std::abs(window.high.x)) + std::abs(window.shear) * t;
  const double largest = std::abs(above.x) * s + std::abs(above.y) * t + std::abs(above.z);
  const double error = 4 * (line.error.x * s + line.error.y * t + line.error.z) + 16 * kUnit * largest;
  // Tested at the end of the left side that is farther from the line, so that a line through the corner is counted
  // once.
  if (!(std::max(std::abs(low), std::abs(high)) > error)) {
    is_open_ = true;
    return;
  }
  if (a == 0 && b == 0) {
    at_corner_ += low > 0 ? 0 : 1;
    return;
  }
  const std::size_t before = left_.size();
  // The edge has its ends far beyond the light on either side, along the line.
  const double squared = a * a + b * b, foot = -(c + a * width / 2 + b * height / 2) / squared;
  const double x = width / 2 + a * foot, y = height / 2 + b * foot, far = 2 * (width + height) / std::sqrt(squared);
  const double sign = a > 0 ? 1 : -1;  // makes the edge run upward
  const double off = 2 * error / std::sqrt(squared);
  if (std::max(std::abs(x), std::abs(y)) < 4 * (width + height) + off) {
    // The right side of the line, where it runs upward, is above the plane if a > 0: one layer less.
    const bool open = corner_is_open_;
    add({x + sign * b * far, y - sign * a * far, x - sign * b * far, y + sign * a * far, a > 0 ? 1 : -1},
        off + 64 * kUnit * (width + height));
    corner_is_open_ = open;  // the corner's depth is that of triangles
  }
  const std::int32_t change = left_.size() > before ? left_.back().change : 0;
  at_corner_ += std::abs(high) > std::abs(low) ? (high > 0 ? 0 : 1) - change : low > 0 ? 0 : 1;
}

/// The window's corner and sides are outside of the outline.
void RowSum::add_outline() {
  const bool open = corner_is_open_;
  for (const RowEdge& edge : region_.outline) add(edge, region_.outline_error);
  corner_is_open_ = open;
  if (!region_.outline.empty()) ++at_corner_;
}

std::optional<double> RowSum::visible_share(std::int32_t depth_at_corner, std::vector<Trapezoid>* parts) {
  const double width = grid_.columns, height = grid_.rows;
  if (parts != nullptr) parts->clear();
  add_outline();
  if (is_open_) return std::nullopt;
  const LightMeasure& measure = region_.measure;
  const auto rounded = static_cast<double>(edges_.size() + left_.size() + 1) * 32 * kUnit * width * height;
  const auto [visible, impossible, weighed, disorder, overlap] =
      sweep_({width, height, edges_, left_, depth_at_corner + at_corner_, parts, measure.plain() ? nullptr : &measure});
  // Where the order of sides is open, a depth may be wrong: as if a side were off by their overlap. The side's own
  // rounding is 16 units of the window.
  side_error_ = largest_error_ + 4 * overlap + 16 * kUnit * (width + height);
  // Proof of the fraction: (bound share).
  const double off = error_ * (width + height + 2) + 4 * disorder + rounded;
  const double off_weighed = off * measure.densest() + static_cast<double>(weighed) * measure.rounding();
  if (!(off_weighed <= kProven * measure.whole()) || !(impossible <= off)) return std::nullopt;
  return std::clamp(visible / measure.whole(), 0.0, 1.0);
}

}  // namespace penumbra::volumes
