#include "volumes/scatter/vectors/row_sweep.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace penumbra::volumes {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

RowSweep::Line RowSweep::line_of(const RowEdge& edge) {
  return {edge.x0, edge.y0, (edge.x1 - edge.x0) / (edge.y1 - edge.y0), edge.y1, edge.x1, edge.k};
}

/// Nothing changes before it.
double RowSweep::next_row() {
  double next = in_.height;
  if (next_edge_ < in_.edges.size()) next = std::min(next, in_.edges[next_edge_].y0);
  if (next_step_ < in_.steps.size()) next = std::min(next, in_.steps[next_step_].y);
  if (next_end_ < ends_.size()) next = std::min(next, ends_[next_end_]);
  return next;
}

/// The gap whose sides cross before all others do, the leftmost of several. Looked for only where the last one found is
/// gone. Four minima side by side do not wait for one another.
std::size_t RowSweep::first_crossing() {
  std::array<double, 4> least{kNever, kNever, kNever, kNever};
  std::size_t i = 0;
  for (; i + least.size() <= crossings_.size(); i += least.size()) {
    for (std::size_t j = 0; j < least.size(); ++j) least[j] = std::min(least[j], crossings_[i + j]);
  }
  for (; i < crossings_.size(); ++i) least[0] = std::min(least[0], crossings_[i]);
  soonest_ = std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
  soonest_is_known_ = true;
  return static_cast<std::size_t>(std::find(crossings_.begin(), crossings_.end(), soonest_) - crossings_.begin());
}

void RowSweep::forget(std::size_t gap) {
  if (crossings_[gap] <= soonest_) soonest_is_known_ = false;
}

void RowSweep::end_gap(std::size_t number, double y) {
  Gap& gap = gaps_[number];
  const double since = std::exchange(gap.since, y), high = y - since;
  if (!(high > 0)) return;
  const Line &left = lines_[number - 1], &right = lines_[number];
  const double low_left = left.at(since), low_right = right.at(since), high_left = left.at(y), high_right = right.at(y);
  const double first = low_right - low_left, last = high_right - high_left, narrowest = std::min(first, last);
  if (narrowest < 0) area_.disorder -= narrowest * high;
  if (gap.depth > 0) return;
  const double area = 0.5 * (first + last) * high;
  if (gap.depth < 0) {
    area_.impossible += area;
    return;
  }
  const Trapezoid part{{since, low_left, low_right}, {y, high_left, high_right}};
  area_.visible += in_.measure != nullptr ? in_.measure->of(part) : area;
  ++area_.parts;
  if (in_.parts != nullptr && area > 0) in_.parts->push_back(part);
}

void RowSweep::look_ahead(std::size_t number, double y) {
  const Line &left = lines_[number - 1], &right = lines_[number];
  double& crossing = crossings_[number];
  forget(number);
  crossing = kNever;
  if (number == 1 || number + 1 == lines_.size()) return;  // edges lie between the light's sides
  const double end = std::min(left.end, right.end);
  if (left.at(end) <= right.at(end)) return;
  const double apart = right.at(y) - left.at(y);
  crossing = apart > 0 ? std::min(y + apart / (left.slope - right.slope), end) : y;
  soonest_ = std::min(soonest_, crossing);
}

void RowSweep::change_places(std::size_t number, double y) {
  for (std::size_t gap = number - 1; gap <= number + 1; ++gap) end_gap(gap, y);
  std::swap(lines_[number - 1], lines_[number]);
  gaps_[number].depth = gaps_[number - 1].depth - lines_[number - 1].k;
  for (std::size_t gap = number - 1; gap <= number + 1; ++gap) look_ahead(gap, y);
}

/// Edges that begin where another ends take its place, so that outlines stay in order. False: depths change, or there
/// are others that begin or end.
bool RowSweep::hand_over(double y) {
  bool all = true;
  for (std::size_t i = 1; i + 1 < lines_.size(); ++i) {
    Line& line = lines_[i];
    if (line.end > y) continue;
    const auto heir =
        std::find_if(begin_.begin(), begin_.end(), [&](const RowEdge& edge) { return edge.x0 == line.last_x; });
    if (heir == begin_.end()) {
      all = false;
      continue;
    }
    all = all && heir->k == line.k;
    end_gap(i, y);
    end_gap(i + 1, y);
    line = line_of(*heir);
    *heir = begin_.back();
    begin_.pop_back();
    look_ahead(i, y);
    look_ahead(i + 1, y);
  }
  return all && begin_.empty();
}

/// The gaps on both sides become one.
void RowSweep::remove(std::size_t line, double y) {
  end_gap(line, y);
  end_gap(line + 1, y);
  forget(line);
  crossings_.erase(crossings_.begin() + static_cast<std::ptrdiff_t>(line));
  lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(line));
  gaps_.erase(gaps_.begin() + static_cast<std::ptrdiff_t>(line));
  gaps_[line].is_new = true;
}

/// Where it is in order at its lower end, and after those that it meets there and that lean more to the left.
void RowSweep::insert(const RowEdge& edge, double y) {
  const Line line = line_of(edge);
  auto place = std::partition_point(lines_.begin() + 1, lines_.end() - 1,
                                    [&](const Line& other) { return other.at(line.y) < line.x; });
  for (; place + 1 != lines_.end(); ++place) {
    const double x = place->at(line.y);
    if (x > line.x || (x == line.x && place->slope > line.slope)) break;
  }
  const auto gap = static_cast<std::size_t>(place - lines_.begin());
  if (!gaps_[gap].is_new) end_gap(gap, y);
  lines_.insert(place, line);
  gaps_.insert(gaps_.begin() + static_cast<std::ptrdiff_t>(gap), Gap{y, 0, true});
  crossings_.insert(crossings_.begin() + static_cast<std::ptrdiff_t>(gap), kNever);
  gaps_[gap + 1].is_new = true;
}

/// Depths from left to right; what gaps with new sides or another depth were ends here.
void RowSweep::renew_gaps(double y) {
  std::int32_t depth = in_.depth;
  for (std::size_t i = 1; i < gaps_.size(); ++i) {
    Gap& gap = gaps_[i];
    if (gap.is_new) {
      gap.since = y;
      gap.is_new = false;
      look_ahead(i, y);
    } else if (gap.depth != depth) {
      end_gap(i, y);
    }
    gap.depth = depth;
    depth -= lines_[i].k;
  }
}

void RowSweep::change_lines(double y) {
  begin_.clear();
  for (; next_edge_ < in_.edges.size() && in_.edges[next_edge_].y0 <= y; ++next_edge_)
    begin_.push_back(in_.edges[next_edge_]);
  std::int32_t change = 0;
  for (; next_step_ < in_.steps.size() && in_.steps[next_step_].y <= y; ++next_step_)
    change += in_.steps[next_step_].change;
  const bool some_end = next_end_ < ends_.size() && ends_[next_end_] <= y;
  while (next_end_ < ends_.size() && ends_[next_end_] <= y) ++next_end_;
  if (some_end && hand_over(y) && change == 0) return;
  in_.depth += change;
  if (some_end) {
    for (std::size_t i = lines_.size() - 2; i > 0; --i) {
      if (lines_[i].end <= y) remove(i, y);
    }
  }
  for (const RowEdge& edge : begin_) insert(edge, y);
  renew_gaps(y);
}

RowSweep::Area RowSweep::operator()(const Input& input) {
  in_ = input;
  area_ = {};
  next_edge_ = next_step_ = 0;
  // By all that they are: sums do not depend on the order in which a hierarchy listed them.
  std::sort(in_.steps.begin(), in_.steps.end());
  std::sort(in_.edges.begin(), in_.edges.end());
  ends_.clear();
  for (const RowEdge& edge : in_.edges) ends_.push_back(edge.y1);
  std::sort(ends_.begin(), ends_.end());
  next_end_ = 0;
  soonest_ = kNever;
  soonest_is_known_ = true;
  lines_ = {{0, 0, 0, kNever, 0, 0}, {in_.width, 0, 0, kNever, in_.width, 0}};
  gaps_ = {{}, {0, in_.depth}};
  crossings_ = {kNever, kNever};
  for (;;) {
    const double next = next_row();
    const std::size_t gap = soonest_ <= next ? first_crossing() : 0;
    if (soonest_ <= next) {
      change_places(gap, soonest_);
    } else if (next < in_.height) {
      change_lines(next);
    } else {
      break;
    }
  }
  for (std::size_t gap = 1; gap < lines_.size(); ++gap) end_gap(gap, in_.height);
  return area_;
}

}  // namespace penumbra::volumes
