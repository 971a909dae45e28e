#include "volumes/native_precise.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::volumes {
namespace {

/// A way from p: across, along, and up to the light. It appears at foot + height / w (x, y).
using Way = glm::vec3;

glm::vec2 appears(const Sample& at, const Way& way) {
  const float q = at.height / way.z;
  return {at.foot.x + q * way.x, at.foot.y + q * way.y};
}

/// (bound X)
float error_of(const Sample& at, float far, float w, float from_foot) {
  return (far + at.far) / w * (at.per_way + kPerReach * from_foot) + at.per_foot * from_foot + at.fixed;
}

class Marks {
 public:
  Marks(const Frame& frame, Open& open) : frame_(frame), open_(open) {}

  void row(float row) {
    if (row >= 0 && row < static_cast<float>(frame_.rows)) open_.rows.push_back(static_cast<std::uint32_t>(row));
  }
  void sample(float row, float column) {
    open_.samples.push_back(static_cast<std::uint32_t>(row) * frame_.columns + static_cast<std::uint32_t>(column));
  }
  void pixel() { open_.pixel = true; }
  void corner() { open_.corner = true; }

  /// What is open where the changes at (row, x) may be anywhere within `error` of x: the nearest light sample, if it is
  /// that near; the row, if others are too.
  void near(float row, float x, float error) {
    if (row < 0 || row >= static_cast<float>(frame_.rows)) return;
    const auto columns = static_cast<float>(frame_.columns);
    const float column = x - frame_.shift[static_cast<std::size_t>(row)], nearest = std::round(column);
    const bool wide = error >= 0.5F && column > -1 - error && column < columns + error;
    if (wide) this->row(row);
    if (!wide && nearest >= 0 && nearest < columns && std::abs(column - nearest) < error) sample(row, nearest);
  }

 private:
  const Frame& frame_;
  Open& open_;
};

/// An edge as it appears, from the end nearer to the light's middle, so that far ends' errors, which grow with their
/// distance, stay small.
struct Seen2 {
  glm::vec2 near, far, low, high;
  float error_near, error_far, slope, steep;
  bool turn;
};

Seen2 as_seen(const Frame& frame, const glm::vec2& a, const glm::vec2& b, float error_a, float error_b) {
  const glm::vec2 to_a = glm::abs(a - frame.first_cell), to_b = glm::abs(b - frame.first_cell);
  const bool turn = to_b.x + to_b.y < to_a.x + to_a.y;
  Seen2 s{turn ? b : a,
          turn ? a : b,
          glm::min(a, b),
          glm::max(a, b),
          turn ? error_b : error_a,
          turn ? error_a : error_b,
          0,
          0,
          turn};
  const glm::vec2 way = s.far - s.near;
  s.slope = way.x / way.y;
  s.steep = way.y == 0 ? 1e30F : std::abs(s.slope);
  return s;
}

float row_at_least(const Frame& frame, float y) {
  return std::clamp(std::ceil(y), 0.0F, static_cast<float>(frame.rows));
}

/// Returns the first row above where the edge crosses the light's left side, if it does: told by the same x as the
/// changes of the rows, so that no row can count it twice, or not at all.
template <typename Counter>
float cross_rows(const Frame& frame, const Seen2& s, Counter jump, const Changes<Counter>* changes, Marks& marks) {
  const auto columns = static_cast<float>(frame.columns);
  const float weight =
      std::min(1.0F, (std::abs(s.near.y - frame.first_cell.y) + 2 * frame.half_cells.y) / std::abs(s.far.y - s.near.y));
  const float error = 1.2F * (s.error_near + weight * s.error_far) * (1 + s.steep) +
                      8 * kRound * (frame.half_cells.x + std::abs(s.near.x));
  const bool upper_right = (s.near.y < s.far.y ? s.far.x : s.near.x) >= -0.5F;
  const float end = row_at_least(frame, s.high.y);
  float from = end;
  for (float row = row_at_least(frame, s.low.y); row < end; ++row) {
    const auto r = static_cast<std::size_t>(row);
    const float x = std::clamp(s.near.x + (row - s.near.y) * s.slope, s.low.x, s.high.x);
    const float column = x - frame.shift[r], nearest = std::round(column), first = std::max(std::ceil(column), 0.0F);
    if ((x >= -0.5F) == upper_right) from = std::min(from, row);
    if (changes != nullptr && x >= -0.5F && first < columns) {
      Counter& cell = changes->cells[static_cast<std::size_t>(first) * frame.padded_rows + r];
      cell = static_cast<Counter>(cell + jump);
    }
    if (!(std::abs(column - nearest) < error && nearest >= 0 && nearest < columns)) continue;
    if (error >= 0.5F) {
      marks.row(row);
    } else {
      marks.sample(row, nearest);
    }
  }
  return from;
}

/// Where it crosses the light's left side: above the corner or below?
template <typename Counter>
void cross_left_side(const Frame& frame, const Seen2& s, float from, Counter up, const Changes<Counter>* changes,
                     Marks& marks) {
  const glm::vec2 way = s.far - s.near;
  const float inverse = way.y / way.x;
  const float weight =
      std::min(1.0F, (std::abs(s.near.x - frame.first_cell.x) + 2 * frame.half_cells.x) / std::abs(way.x));
  const float error = 1.2F * (s.error_near + s.error_far * weight) * (1 + std::abs(inverse)) +
                      8 * kRound * (frame.half_cells.y + std::abs(s.near.y));
  const float y = std::clamp(s.near.y + (-0.5F - s.near.x) * inverse, s.low.y, s.high.y);
  if (std::abs(y + 0.5F) < error) marks.corner();
  if (changes == nullptr || y <= -0.5F || from >= static_cast<float>(frame.rows)) return;
  Counter& row = changes->left[static_cast<std::size_t>(from)];
  row = static_cast<Counter>(row + up);
}

/// The part of an edge in a window of about twice the light. (bound window)
struct Cut {
  Way start, end;
  bool cut = false, nothing = false;
};

Cut cut_to_window(const Frame& frame, const Sample& at, const Way& a, const Way& b) {
  const glm::vec2 window = 2.0F * frame.half_cells + 2.0F, off = at.foot - frame.first_cell;
  float from = 0, to = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const float xa = a[axis] * at.height + off[axis] * a.z, xb = b[axis] * at.height + off[axis] * b.z;
    for (const float sign : {-1.0F, 1.0F}) {
      const float inside_a = window[axis] * a.z + sign * xa, inside_b = window[axis] * b.z + sign * xb;
      const float t = inside_a / (inside_a - inside_b);
      if (inside_a < 0) from = std::max(from, inside_b < 0 ? 2.0F : t);
      if (inside_a >= 0 && inside_b < 0) to = std::min(to, t);
    }
  }
  return {from > 0 ? glm::mix(a, b, from) : a, to < 1 ? glm::mix(a, b, to) : b, from > 0 || to<1, from> to};
}

}  // namespace

template <typename Counter>
void scatter_precisely(const PreciseInput& in, const Changes<Counter>* changes, Open& open) {
  const auto& [frame, at, edges, edge, k, is_open, settled] = in;
  Marks marks(frame, open);
  const Way a(edges[kAx][edge] - at.seen.x, edges[kAy][edge] - at.seen.y, at.seen.z - edges[kAh][edge]);
  const Way b(edges[kBx][edge] - at.seen.x, edges[kBy][edge] - at.seen.y, at.seen.z - edges[kBh][edge]);
  const Cut part = settled ? Cut{a, b} : cut_to_window(frame, at, a, b);
  if (part.nothing || (k == 0 && !is_open)) return;
  const float far = edges[kFar][edge], lowest = std::min(part.start.z, part.end.z);
  if (!settled && lowest < 64 * kRound * (far + at.far)) {  // it passes through p, but for rounding
    marks.pixel();
    return;
  }
  const glm::vec2 seen_a = appears(at, part.start), seen_b = appears(at, part.end);
  const float foot_a = glm::length(seen_a - at.foot), foot_b = glm::length(seen_b - at.foot);
  // Where p is within rounding of a triangle's plane, samples that the triangle may hide are as near to its edges as if
  // those were off their places by this. (bound sliver)
  const float sliver = is_open ? 40 * kRound * (edges[kAnchorFar][edge] + at.far) : 0;
  const float straight = at.height * frame.per_length;
  const auto off = [&](float foot, float w) { return (straight + foot) / w * sliver; };
  const Seen2 seen = as_seen(frame, seen_a, seen_b, error_of(at, far, part.start.z, foot_a) + off(foot_a, part.start.z),
                             error_of(at, far, part.end.z, foot_b) + off(foot_b, part.end.z));
  for (const auto& [end, error] : {std::pair(seen.near, seen.error_near), std::pair(seen.far, seen.error_far)}) {
    const float row = std::round(end.y);
    if (std::abs(end.y - row) < error) marks.near(row, end.x, 1.2F * error * (1 + seen.steep));
  }
  const auto jump = static_cast<Counter>((seen.near.y < seen.far.y) == seen.turn ? k : -k);
  const float from = cross_rows(frame, seen, jump, changes, marks);
  if ((seen_a.x < -0.5F) == (seen_b.x < -0.5F)) return;
  cross_left_side(frame, seen, from, static_cast<Counter>(seen_a.x < seen_b.x ? k : -k), changes, marks);
}

template void scatter_precisely(const PreciseInput&, const Changes<std::int16_t>*, Open&);
template void scatter_precisely(const PreciseInput&, const Changes<std::int32_t>*, Open&);

}  // namespace penumbra::volumes
