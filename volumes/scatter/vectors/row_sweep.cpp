#include "volumes/scatter/vectors/row_sweep.hpp"

#include <algorithm>
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
double RowSweep::next_row() const {
  double next = in_.height;
  if (next_edge_ < in_.edges.size()) next = std::min(next, in_.edges[next_edge_].y0);
  if (next_step_ < in_.steps.size()) next = std::min(next, in_.steps[next_step_].y);
  for (const Line& line : lines_) next = std::min(next, line.end);
  return next;
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
  (gap.depth == 0 ? area_.visible : area_.impossible) += area;
  if (gap.depth == 0 && in_.parts != nullptr && area > 0) {
    in_.parts->push_back({{since, low_left, low_right}, {y, high_left, high_right}});
  }
}

void RowSweep::end_gaps(double y) {
  for (std::size_t gap = 1; gap < lines_.size(); ++gap) end_gap(gap, y);
}

void RowSweep::look_ahead(std::size_t number, double y) {
  const Line &left = lines_[number - 1], &right = lines_[number];
  double& crossing = gaps_[number].crossing;
  crossing = kNever;
  if (number == 1 || number + 1 == lines_.size()) return;  // edges lie between the light's sides
  const double end = std::min(left.end, right.end);
  if (left.at(end) <= right.at(end)) return;
  const double apart = right.at(y) - left.at(y);
  crossing = apart > 0 ? std::min(y + apart / (left.slope - right.slope), end) : y;
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

void RowSweep::insert(const RowEdge& edge) {
  const Line line = line_of(edge);
  auto place = lines_.begin() + 1;
  for (; place + 1 != lines_.end(); ++place) {
    const double x = place->at(line.y);
    if (x > line.x || (x == line.x && place->slope > line.slope)) break;
  }
  lines_.insert(place, line);
}

void RowSweep::change_lines(double y) {
  begin_.clear();
  for (; next_edge_ < in_.edges.size() && in_.edges[next_edge_].y0 <= y; ++next_edge_)
    begin_.push_back(in_.edges[next_edge_]);
  std::int32_t change = 0;
  for (; next_step_ < in_.steps.size() && in_.steps[next_step_].y <= y; ++next_step_)
    change += in_.steps[next_step_].change;
  if (hand_over(y) && change == 0) return;
  end_gaps(y);
  in_.depth += change;
  std::erase_if(lines_, [y](const Line& line) { return line.end <= y; });
  for (const RowEdge& edge : begin_) insert(edge);
  gaps_.resize(lines_.size());
  std::int32_t depth = in_.depth;
  for (std::size_t gap = 1; gap < lines_.size(); ++gap) {
    gaps_[gap] = {y, kNever, depth};
    look_ahead(gap, y);
    depth -= lines_[gap].k;
  }
}

RowSweep::Area RowSweep::operator()(const Input& input) {
  in_ = input;
  area_ = {};
  next_edge_ = next_step_ = 0;
  std::sort(in_.steps.begin(), in_.steps.end(), [](const RowStep& a, const RowStep& b) { return a.y < b.y; });
  std::sort(in_.edges.begin(), in_.edges.end(), [](const RowEdge& a, const RowEdge& b) { return a.y0 < b.y0; });
  lines_ = {{0, 0, 0, kNever, 0, 0}, {in_.width, 0, 0, kNever, in_.width, 0}};
  gaps_ = {{}, {0, kNever, in_.depth}};
  for (;;) {
    const double next = next_row();
    const auto crossing = std::min_element(gaps_.begin() + 1, gaps_.end(),
                                           [](const Gap& a, const Gap& b) { return a.crossing < b.crossing; });
    if (crossing->crossing <= next) {
      change_places(static_cast<std::size_t>(crossing - gaps_.begin()), crossing->crossing);
    } else if (next < in_.height) {
      change_lines(next);
    } else {
      break;
    }
  }
  end_gaps(in_.height);
  return area_;
}

}  // namespace penumbra::volumes
