#include "volumes/native_rows.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::volumes {
namespace {

double at_height(const RowEdge& edge, double y) {
  const double t = std::clamp((y - edge.y0) / (edge.y1 - edge.y0), 0.0, 1.0);
  return edge.x0 + t * (edge.x1 - edge.x0);
}

}  // namespace

void RowSum::set(const CrossingTable& edges) {
  edges_.clear();
  left_.clear();
  bends_.clear();
  at_corner_ = 0;
  impossible_ = 0;
  corner_is_open_ = false;
  for (std::size_t i = 0; i < edges.count; ++i) {
    const float k = frame_.side < 0 ? -edges[kK][i] : edges[kK][i];
    if (k == 0) continue;
    add({edges[kX0][i] + 0.5, edges[kY0][i] + 0.5, edges[kX1][i] + 0.5, edges[kY1][i] + 0.5,
         static_cast<std::int32_t>(k)},
        edges[kError][i]);
  }
}

void RowSum::add(RowEdge edge, double error) {
  const double width = frame_.columns, height = frame_.rows;
  if (edge.y0 > edge.y1) edge = {edge.x1, edge.y1, edge.x0, edge.y0, -edge.k};
  if ((edge.x0 < 0) != (edge.x1 < 0)) {
    const double y = edge.y0 + (0 - edge.x0) / (edge.x1 - edge.x0) * (edge.y1 - edge.y0);
    const double steep = std::abs((edge.y1 - edge.y0) / (edge.x1 - edge.x0));
    if (std::abs(y) < 2.41 * error * (1 + steep)) corner_is_open_ = true;
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
  bends_.push_back(edge.y0);
  bends_.push_back(edge.y1);
  if (edge.y0 < edge.y1) edges_.push_back(edge);
}

std::optional<std::int32_t> RowSum::relative_depth(std::uint32_t light_sample) const {
  constexpr double kNear = 1e-3;
  const std::uint32_t row = light_sample / frame_.columns;
  const double x = light_sample % frame_.columns + 0.5 + static_cast<double>(frame_.shift[row]), y = row + 0.5;
  std::int32_t depth = 0;
  for (const Step& step : left_) {
    if (std::abs(step.y - y) < kNear) return std::nullopt;
    if (step.y < y) depth += step.change;
  }
  for (const RowEdge& edge : edges_) {
    if (edge.y0 > y + kNear || edge.y1 < y - kNear) continue;
    if (std::abs(edge.y0 - y) < kNear || std::abs(edge.y1 - y) < kNear) return std::nullopt;
    const double crossing = at_height(edge, y);
    if (std::abs(crossing - x) < kNear) return std::nullopt;
    if (crossing < x) depth -= edge.k;
  }
  return depth;
}

void RowSum::add_horizon(const Placed& at) {
  const double width = frame_.columns, height = frame_.rows;
  // above · (s, t, 1) as a X + b Y + c, from the light's corner.
  const double a = 2 * static_cast<double>(at.above.x) / width, b = 2 * static_cast<double>(at.above.y) / height;
  const double c = static_cast<double>(at.above.z) - static_cast<double>(at.above.x) - static_cast<double>(at.above.y);
  if (c <= 0) ++at_corner_;
  if (a == 0 && b == 0) return;
  // Far beyond the light on either side, along the line.
  const double squared = a * a + b * b, foot = -(c + a * width / 2 + b * height / 2) / squared;
  const double x = width / 2 + a * foot, y = height / 2 + b * foot, far = 2 * (width + height) / std::sqrt(squared);
  const double sign = a > 0 ? 1 : -1;  // upward
  // To the right of it, where it runs upward, is above the plane if a > 0: one layer less.
  add({x + sign * b * far, y - sign * a * far, x - sign * b * far, y + sign * a * far, a > 0 ? 1 : -1}, 0);
}

/// The visible length of a row whose crossings are in order.
double RowSum::visible_length(std::int32_t depth, double height) {
  const double width = frame_.columns;
  double length = 0, from = 0;
  const auto pass = [&](double x) {
    if (depth == 0) length += x - from;
    if (depth < 0) impossible_ += (x - from) * height;
    from = x;
  };
  for (const Spanning& spanning : active_) {
    pass(spanning.x);
    depth -= spanning.edge->k;
  }
  pass(width);
  return length;
}

/// Between two rows that no edge begins or ends between. If edges cross there, up to where they first do, and on.
double RowSum::visible_area(double from, double to, std::int32_t depth, int halvings) {
  const double middle = 0.5 * (from + to), height = to - from;
  for (Spanning& spanning : active_) spanning.x = at_height(*spanning.edge, middle);
  // Few, and nearly in order from the row before.
  for (std::size_t i = 1; i < active_.size(); ++i) {
    const Spanning moved = active_[i];
    std::size_t j = i;
    for (; j > 0 && active_[j - 1].x > moved.x; --j) active_[j] = active_[j - 1];
    active_[j] = moved;
  }
  if (halvings > 0) {
    for (std::size_t i = 1; i < active_.size(); ++i) {
      const RowEdge &l = *active_[i - 1].edge, &r = *active_[i].edge;
      const double at_from = at_height(r, from) - at_height(l, from), at_to = at_height(r, to) - at_height(l, to);
      // Crossings of less than a millionth of a cell change no digit that a float has.
      if (at_from > -1e-6 && at_to > -1e-6) continue;
      const double cut =
          std::clamp(from + height * at_from / (at_from - at_to), from + 1e-3 * height, to - 1e-3 * height);
      const double below = visible_area(from, cut, depth, halvings - 1);
      return below + visible_area(cut, to, depth, halvings - 1);
    }
  }
  return visible_length(depth, height) * height;
}

std::optional<double> RowSum::visible_share(std::int32_t depth_at_corner) {
  const double width = frame_.columns, height = frame_.rows;
  constexpr int kMostHalvings = 64;
  std::int32_t depth = depth_at_corner + at_corner_;
  for (const Step& step : left_) bends_.push_back(step.y);
  bends_.push_back(0);
  bends_.push_back(height);
  std::sort(bends_.begin(), bends_.end());
  std::sort(left_.begin(), left_.end(), [](const Step& a, const Step& b) { return a.y < b.y; });
  std::sort(edges_.begin(), edges_.end(), [](const RowEdge& a, const RowEdge& b) { return a.y0 < b.y0; });
  active_.clear();
  std::size_t next = 0, step = 0;
  double area = 0;
  for (std::size_t i = 0; i + 1 < bends_.size(); ++i) {
    const double from = bends_[i], to = bends_[i + 1];
    for (; step < left_.size() && left_[step].y <= from; ++step) depth += left_[step].change;
    if (!(to > from)) continue;
    std::erase_if(active_, [&](const Spanning& s) { return s.edge->y1 <= from; });
    for (; next < edges_.size() && edges_[next].y0 <= from; ++next) {
      if (edges_[next].y1 > from) active_.push_back({&edges_[next], 0});
    }
    area += visible_area(from, to, depth, kMostHalvings);
  }
  if (impossible_ > 1e-4 * width * height) return std::nullopt;
  return area / (width * height);
}

float share_above_horizon(const Frame& frame, const Placed& at) {
  RowSum rows(frame);
  rows.set(CrossingTable{});
  rows.add_horizon(at);
  return static_cast<float>(rows.visible_share(0).value_or(0));
}

}  // namespace penumbra::volumes
