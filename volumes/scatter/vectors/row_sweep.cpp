// SPDX-License-Identifier: Apache-2.0
// Area of depth zero by a sweep over projected edges (Bentley and Ottmann 1979), with a bound of its disorder.
// docs/edge-scatter.md, "Without light samples".

#include "volumes/scatter/vectors/row_sweep.hpp"

#include "volumes/scatter/vectors/first_least.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace penumbra::volumes {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

/// Linear time in most cases: as many buckets of heights as edges. Compares all fields, so that sums do not depend on
/// the order in which a hierarchy listed the edges.
void RowSweep::sort_edges() {
  constexpr std::size_t kFew = 16;
  const std::span<RowEdge> edges = in_.edges;
  const std::size_t last = edges.size() - std::min<std::size_t>(edges.size(), 1);
  const double per_height = static_cast<double>(edges.size()) / in_.height;
  const auto bucket_of = [&](const RowEdge& edge) {
    return std::min(static_cast<std::size_t>(edge.y0 * per_height), last);
  };
  buckets_.assign(edges.size() + 1, 0);
  for (const RowEdge& edge : edges) ++buckets_[bucket_of(edge) + 1];
  std::partial_sum(buckets_.begin(), buckets_.end(), buckets_.begin());
  by_bucket_.resize(edges.size());
  for (const RowEdge& edge : edges) by_bucket_[buckets_[bucket_of(edge)]++] = edge;
  std::size_t begin = 0;  // first index of a bucket; afterwards `ends` holds the bucket's end
  for (std::size_t bucket = 0; bucket < edges.size(); ++bucket) {
    const std::size_t end = buckets_[bucket];
    for (std::size_t i = begin; i < end; ++i) {
      std::size_t place = i;
      if (end - begin <= kFew) {
        for (; place > begin && by_bucket_[i] < edges[place - 1]; --place) edges[place] = edges[place - 1];
      }
      edges[place] = by_bucket_[i];
    }
    if (end - begin > kFew) std::ranges::sort(edges.subspan(begin, end - begin), std::less());
    begin = end;
  }
}

RowSweep::Line RowSweep::line_of(const RowEdge& edge) {
  return {edge.x0, edge.y0, (edge.x1 - edge.x0) / (edge.y1 - edge.y0), edge.y1, edge.x1, edge.k};
}

/// Returns the height of the next event; nothing changes before it.
double RowSweep::next_row() const {
  double next = in_.height;
  if (next_edge_ < in_.edges.size()) next = std::min(next, in_.edges[next_edge_].y0);
  if (next_step_ < in_.steps.size()) next = std::min(next, in_.steps[next_step_].y);
  return std::min(next, soonest_end_);
}

/// Finds the gap whose sides cross first (the leftmost, if there are several), unless the last one found is still
/// valid.
void RowSweep::find_first_crossing() {
  const FirstLeast found = first_least(crossings_);
  soonest_ = found.least;
  first_ = found.at;
}

/// Invalidates the cached first crossing if it may be the crossing of this gap's sides.
void RowSweep::forget(std::size_t gap) {
  if (crossings_[gap] <= soonest_) first_ = kUnknown;
}

inline void RowSweep::end_gap(std::size_t number, double y) {
  if (const Gap& gap = gaps_[number]; gap.depth > 0 && gap.is_in_order) {
    ++ends_in_order_;
    return;
  }
  measure_gap(number, y);
}

void RowSweep::measure_gap(std::size_t number, double y) {
  Gap& gap = gaps_[number];
  const double since = std::exchange(gap.since, y), high = y - since;
  if (!(high > 0)) return;
  const double low_left = gap.left, low_right = gap.right, high_left = lines_[number - 1].at(y),
               high_right = lines_[number].at(y);
  const double first = low_right - low_left, last = high_right - high_left, narrowest = std::min(first, last);
  if (narrowest < 0) {
    area_.disorder -= narrowest * high;
    area_.overlap = std::max(area_.overlap, -narrowest);
  }
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

/// Begins a gap with new sides or a new depth: computes its sides at y, and their crossing.
void RowSweep::begin_gap(std::size_t number, double y) {
  const Line &left = lines_[number - 1], &right = lines_[number];
  Gap& gap = gaps_[number];
  gap.since = y;
  gap.left = left.at(y);
  gap.right = right.at(y);
  const double end = std::min(std::min(left.end, right.end), in_.height);
  const double apart = gap.right - gap.left, last = right.at(end) - left.at(end);
  gap.is_in_order = apart >= 0;
  double& crossing = crossings_[number];
  forget(number);
  crossing = kNever;
  if (last >= 0 || number == 1 || number + 1 == lines_.size()) return;  // edges lie between the light's sides
  // The computed crossing of nearly coincident lines can be below y; the lower of the two lines' ends is used instead.
  const double closing = left.slope - right.slope;
  crossing = apart <= 0 ? y : closing > 0 ? std::min(y + apart / closing, end) : end;
  if (crossing < soonest_) {
    soonest_ = crossing;
    first_ = number;
  } else if (crossing == soonest_ && first_ != kUnknown) {
    first_ = std::min(first_, number);
  }
}

void RowSweep::change_places(std::size_t number, double y) {
  for (std::size_t gap = number - 1; gap <= number + 1; ++gap) end_gap(gap, y);
  std::swap(lines_[number - 1], lines_[number]);
  std::swap(ends_[number - 1], ends_[number]);
  if (first_end_ == number || first_end_ + 1 == number)
    first_end_ = ends_[number - 1] == soonest_end_ ? number - 1 : number;
  forget(number);
  crossings_[number] = kNever;  // any two lines exchange places at most once
  Gap& gap = gaps_[number];
  gap.since = y;
  gap.left = lines_[number - 1].at(y);
  gap.right = lines_[number].at(y);
  gap.depth = gaps_[number - 1].depth - static_cast<std::int32_t>(lines_[number - 1].k);
  gap.is_in_order = true;
  begin_gap(number - 1, y);
  begin_gap(number + 1, y);
}

/// Replaces edges that end at y with edges that begin at y, to keep outlines in order. Returns false if depths change,
/// or if other edges begin or end.
bool RowSweep::hand_over(double y) {
  bool all = true;
  for (std::size_t i = first_end_; i + 1 < lines_.size(); ++i) {
    if (ends_[i] > y) continue;
    Line& line = lines_[i];
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
    ends_[i] = line.end;
    *heir = begin_.back();
    begin_.pop_back();
    begin_gap(i, y);
    begin_gap(i + 1, y);
  }
  return all && begin_.empty();
}

/// Removes a line, and merges the gaps on both of its sides.
void RowSweep::remove(std::size_t line, double y) {
  end_gap(line, y);
  end_gap(line + 1, y);
  forget(line);
  if (first_ != kUnknown && first_ > line) --first_;
  crossings_.erase(crossings_.begin() + static_cast<std::ptrdiff_t>(line));
  lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(line));
  ends_.erase(ends_.begin() + static_cast<std::ptrdiff_t>(line));
  gaps_.erase(gaps_.begin() + static_cast<std::ptrdiff_t>(line));
  gaps_[line].is_new = true;
}

/// Inserts a line where it is in order at its lower end, after lines that it meets there and that lean more to the
/// left.
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
  ends_.insert(ends_.begin() + static_cast<std::ptrdiff_t>(gap), line.end);
  gaps_.insert(gaps_.begin() + static_cast<std::ptrdiff_t>(gap), Gap{.since = y, .is_new = true});
  crossings_.insert(crossings_.begin() + static_cast<std::ptrdiff_t>(gap), kNever);
  gaps_[gap + 1].is_new = true;
  if (first_ != kUnknown && first_ >= gap) ++first_;
}

/// Updates depths from left to right; ends gaps whose sides or depth changed.
void RowSweep::renew_gaps(double y) {
  std::int32_t depth = in_.depth;
  for (std::size_t i = 1; i < gaps_.size(); ++i) {
    Gap& gap = gaps_[i];
    if (gap.is_new) {
      gap.is_new = false;
      begin_gap(i, y);
    } else if (gap.depth != depth) {
      end_gap(i, y);
      gap.since = y;
      gap.left = lines_[i - 1].at(y);
      gap.right = lines_[i].at(y);
    }
    gap.depth = depth;
    depth -= static_cast<std::int32_t>(lines_[i].k);
  }
}

void RowSweep::change_lines(double y) {
  begin_.clear();
  for (; next_edge_ < in_.edges.size() && in_.edges[next_edge_].y0 <= y; ++next_edge_)
    begin_.push_back(in_.edges[next_edge_]);
  std::int32_t change = 0;
  for (; next_step_ < in_.steps.size() && in_.steps[next_step_].y <= y; ++next_step_)
    change += in_.steps[next_step_].change;
  const bool some_end = soonest_end_ <= y, all_go_on = some_end && hand_over(y);
  if (!all_go_on || change != 0) {
    in_.depth += change;
    if (some_end) {
      for (std::size_t i = lines_.size() - 2; i > 0; --i) {
        if (ends_[i] <= y) remove(i, y);
      }
    }
    for (const RowEdge& edge : begin_) insert(edge, y);
    renew_gaps(y);
  }
  find_first_end();
}

void RowSweep::find_first_end() {
  const FirstLeast found = first_least(ends_);
  soonest_end_ = found.least;
  first_end_ = found.at;
}

RowSweep::Area RowSweep::operator()(const Input& input) {
  in_ = input;
  area_ = {};
  next_edge_ = next_step_ = 0;
  std::sort(in_.steps.begin(), in_.steps.end());
  sort_edges();
  ends_in_order_ = 0;
  soonest_ = soonest_end_ = kNever;
  first_ = kUnknown;
  lines_ = {{0, 0, 0, kNever, 0, 0}, {in_.width, 0, 0, kNever, in_.width, 0}};
  ends_.assign(lines_.size() + kRoom, kNever);
  gaps_ = {{}, {.depth = in_.depth}};
  crossings_.assign(lines_.size() + kRoom, kNever);
  begin_gap(1, 0);
  for (;;) {
    const double next = next_row();
    if (first_ == kUnknown && soonest_ <= next) find_first_crossing();
    if (soonest_ <= next) {
      change_places(first_, soonest_);
    } else if (next < in_.height) {
      change_lines(next);
    } else {
      break;
    }
  }
  for (std::size_t gap = 1; gap < lines_.size(); ++gap) end_gap(gap, in_.height);
  // A gap that begins in order and ends no later than the crossing of its sides is in order up to rounding. Line::at
  // rounds a difference, a product and a sum, none of which exceeds the width by more than rounding: it is off by 3 ·
  // 2⁻⁵³ of the width, and a computed gap width by 7, bounded by 8. Between two heights, a straight gap is no narrower
  // than at one of them; with rounding at both heights and between them, that is 16. The crossing of the sides is off
  // by 4 · 2⁻⁵³ of the height, and the gap there by that fraction of the total change of its width, which is at most
  // twice the light's: 8 more.
  area_.disorder += static_cast<double>(ends_in_order_) * 0x1p-48 * in_.width * in_.height;
  area_.overlap = std::max(area_.overlap, 0x1p-48 * in_.width);
  return area_;
}

}  // namespace penumbra::volumes
