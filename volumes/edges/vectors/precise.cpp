// SPDX-License-Identifier: Apache-2.0
// Handles one edge for one view sample in scalar code, with the operations of the vector code, and decides exactly
// where rounding matters. docs/edge-scatter.md derives the bounds.

#include "volumes/edges/vectors/precise.hpp"

#include "volumes/edges/vectors/disk_cuts.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra::volumes {
namespace {

/// A vector from p: its components across, along and up to the light. Its place on the light is foot + height / w (x,
/// y).
using Direction = glm::vec3;

glm::vec2 appears(const Placing& place, const Direction& direction) {
  const float q = place.height / direction.z;
  return {place.foot.x + q * direction.x, place.foot.y + q * direction.y};
}

/// Returns the vector in the coordinates of the light as seen from p.
Direction turned(const LightGrid& grid, const ClusterSample& at, const Direction& direction) {
  if (!grid.cones) return direction;
  const auto along = [&](glm::length_t row) {
    return (at.turn[0][row] * direction.x + at.turn[1][row] * direction.y) + at.turn[2][row] * direction.z;
  };
  return {along(0), along(1), along(2)};
}

/// Returns the error of a place. (bound X)
float error_of(const Placing& place, float far, float w, float from_foot) {
  return far / w * (place.per_ray + place.per_reach * from_foot) + place.per_foot * from_foot + place.fixed;
}

/// Returns the length of an end's vector for use in the bounds. If the light's plane may have cut the end, the length
/// includes the end's error. (bound cut)
float far_of(const LightGrid& grid, const Placing& place, const Direction& direction, float far) {
  return place.height - direction.z < near_cut(grid) ? far + cut_far(grid) : far;
}

class Marks {
 public:
  Marks(const LightGrid& grid, Open& open) : grid_(grid), open_(open) {}

  void row(float row) {
    if (row >= 0 && row < static_cast<float>(grid_.rows)) open_.rows.push_back(static_cast<std::uint32_t>(row));
  }
  void sample(float row, float column) {
    open_.samples.push_back(static_cast<std::uint32_t>(row) * grid_.columns + static_cast<std::uint32_t>(column));
  }
  void corner() { open_.corner = true; }

  /// Marks the light samples left open by a change that may be anywhere within `error` of x in this row: the nearest
  /// sample, if it is that close; or the whole row, if other samples are that close, too.
  void near(float row, float x, float error) {
    if (row < 0 || row >= static_cast<float>(grid_.rows)) return;
    const auto columns = static_cast<float>(grid_.columns);
    const float column = x - grid_.shift[static_cast<std::size_t>(row)], nearest = std::round(column);
    const bool wide = error >= 0.5F && column > -1 - error && column < columns + error;
    if (wide) this->row(row);
    if (!wide && nearest >= 0 && nearest < columns && std::abs(column - nearest) < error) sample(row, nearest);
  }

 private:
  const LightGrid& grid_;
  Open& open_;
};

ProjectedEdge project_edge(const LightGrid& grid, const glm::vec2& a, const glm::vec2& b, float error_a,
                           float error_b) {
  const glm::vec2 to_a = glm::abs(a - grid.first_cell), to_b = glm::abs(b - grid.first_cell);
  const bool turn = to_b.x + to_b.y < to_a.x + to_a.y;
  ProjectedEdge s{turn ? b : a,
                  turn ? a : b,
                  glm::min(a, b),
                  glm::max(a, b),
                  turn ? error_b : error_a,
                  turn ? error_a : error_b,
                  0,
                  0,
                  turn,
                  false};
  const glm::vec2 direction = s.far - s.near;
  s.slope = direction.x / direction.y;
  s.steep = direction.y == 0 ? 1e30F : std::abs(s.slope);
  return s;
}

float row_at_least(const LightGrid& grid, float y) {
  return std::clamp(std::ceil(y), 0.0F, static_cast<float>(grid.rows));
}

/// Returns the first light sample of a row that is right of the edge, between `lowest` and one after `highest`.
float first_right_of(const PreciseInput& in, float row, float lowest, float highest, bool runs_up, Marks& marks) {
  float first = lowest;
  for (; first <= highest; ++first) {
    const std::uint32_t sample =
        static_cast<std::uint32_t>(row) * in.of.grid.columns + static_cast<std::uint32_t>(first);
    const int side = side_of_direction(in, glm::dvec3(in.of.grid.points[sample]) - glm::dvec3(in.at.p));
    if (side == 0) {
      marks.sample(row, first);
    } else if ((side < 0) == runs_up) {  // the sample is right of the edge
      break;
    }
  }
  return first;
}

/// Returns the error of a crossing's x on any row of the light.
float error_of_rows(const LightGrid& grid, const ProjectedEdge& s) {
  const float weight =
      std::min(1.0F, (std::abs(s.near.y - grid.first_cell.y) + 2 * grid.half_cells.y) / std::abs(s.far.y - s.near.y));
  return 1.2F * (s.error_near + weight * s.error_far) * (1 + s.steep) +
         8 * kRound * (grid.half_cells.x + std::abs(s.near.x));
}

/// Returns whether the edge may pass the light's corner on either side. The corner's own depth is counted in double,
/// which may be more precise.
bool passes_corner(const LightGrid& grid, const ProjectedEdge& s) {
  const float around = s.error_near + s.error_far;
  if (s.low.x - around > -0.5F || s.high.x + around < -0.5F) return false;
  if (s.low.y - around > -0.5F || s.high.y + around < -0.5F) return false;
  const float x = std::clamp(s.near.x + (-0.5F - s.near.y) * s.slope, s.low.x, s.high.x);
  return !(std::abs(x + 0.5F) >= error_of_rows(grid, s));  // also true for level edges, whose x is NaN
}

/// Returns the first row above the point where the edge crosses the light's left side, if it does. The x that decides
/// the crossing is also the one that changes the rows, so that no row counts the edge twice, or not at all.
template <typename Counter>
float cross_rows(const PreciseInput& in, const ProjectedEdge& s, Counter jump, const Changes<Counter>& changes,
                 Marks& marks) {
  const LightGrid& grid = in.of.grid;
  const auto columns = static_cast<float>(grid.columns);
  const float error = error_of_rows(grid, s);
  const bool upper_right = (s.near.y < s.far.y ? s.far.x : s.near.x) >= -0.5F;
  const bool runs_up = (s.near.y < s.far.y) != s.turn;
  const float end = row_at_least(grid, s.high.y);
  const auto change = [&](float column, float row, Counter by) {
    if (column >= columns) return;
    Counter& cell = changes.cells[static_cast<std::size_t>(column) * grid.padded_rows + static_cast<std::size_t>(row)];
    cell = static_cast<Counter>(cell + by);
  };
  float from = end;
  for (float row = row_at_least(grid, s.low.y); row < end; ++row) {
    const float x = std::clamp(s.near.x + (row - s.near.y) * s.slope, s.low.x, s.high.x);
    const float column = x - grid.shift[static_cast<std::size_t>(row)];
    const float computed = std::max(std::ceil(column), 0.0F);
    const bool on_light = x >= -0.5F;  // else the crossing is included in the depth at the left side
    if (on_light == upper_right) from = std::min(from, row);
    // The light samples from `lowest` to `highest` may be on either side of the edge.
    const float lowest = std::max(std::ceil(column - error), 0.0F);
    const float highest = std::min(std::floor(column + error), columns - 1);
    float first = on_light ? computed : 0;
    if (lowest <= highest) {
      // An end that may be on either side of the row makes its crossing uncertain.
      const bool at_end = std::abs(s.near.y - row) < 2 * s.error_near || std::abs(s.far.y - row) < 2 * s.error_far;
      if (at_end || s.may_be_cut) {
        if (lowest < highest) marks.row(row);
        if (lowest == highest) marks.sample(row, lowest);
      } else {
        first = first_right_of(in, row, lowest, highest, runs_up, marks);
      }
    }
    if (on_light && !in.projected) change(first, row, jump);
    const float was = on_light ? computed : 0;
    if (first == was || (on_light && !in.projected)) continue;
    change(was, row, static_cast<Counter>(-jump));
    change(first, row, jump);
  }
  return from;
}

/// Adds the change where the edge crosses the light's left side, above or below the corner.
template <typename Counter>
void cross_left_side(const PreciseInput& in, const ProjectedEdge& s, float from, Counter up,
                     const Changes<Counter>& changes, Marks& marks) {
  const LightGrid& grid = in.of.grid;
  const glm::vec2 direction = s.far - s.near;
  const float inverse = direction.y / direction.x;
  const float weight =
      std::min(1.0F, (std::abs(s.near.x - grid.first_cell.x) + 2 * grid.half_cells.x) / std::abs(direction.x));
  const float error = 1.2F * (s.error_near + s.error_far * weight) * (1 + std::abs(inverse)) +
                      8 * kRound * (grid.half_cells.y + std::abs(s.near.y));
  const float y = std::clamp(s.near.y + (-0.5F - s.near.x) * inverse, s.low.y, s.high.y);
  if (std::abs(y + 0.5F) < error) marks.corner();
  // Next to light rows, `from` decides more precisely than the division: y is used only below the first row.
  const bool over_corner = from > 0 || y > -0.5F;
  if (in.projected || !over_corner || from >= static_cast<float>(grid.rows)) return;
  Counter& row = changes.left[static_cast<std::size_t>(from)];
  row = static_cast<Counter>(row + up);
}

/// Returns the stored ends.
std::array<glm::dvec3, 2> ends_of(const ClusterInput& in, std::size_t edge) {
  const auto slot = std::bit_cast<std::uint32_t>(in.edges[kEdgeSlot][edge]);
  const WideEdges& leaf = in.edge_tree.leaves[slot / kWide];
  const auto point = [&](const WidePoints& end) {
    const std::size_t lane = slot % kWide;
    return glm::dvec3(end[0][lane], end[1][lane], end[2][lane]);
  };
  return {point(leaf.a), point(leaf.b)};
}

/// The part of an edge in a window of about twice the light. (bound window)
struct WindowPart {
  Direction start, end;
  float far_start, far_end;
  bool passes_at_start = false, passes_at_end = false;  ///< the edge crosses a sphere's disk there
  bool is_empty = false;
};

/// Clips an edge to the window, which is widened by the lift, so that rounding cannot put an edge at p's own height
/// below the window.
WindowPart cut_to_window(const LightGrid& grid, const ClusterSample& at, const Direction& a, const Direction& b,
                         float far_a, float far_b, const PassingEdge& passing) {
  const Placing& place = at.on_light;
  const float lift = place.per_lift * std::max(far_a, far_b);
  const glm::vec2 window = 2.0F * grid.half_cells + 2.0F, off = place.foot - grid.first_cell;
  float from = passing.behind[0] ? passing.share : 0, to = passing.behind[1] ? passing.share : 1;
  const auto cut = [&](float inside_a, float inside_b) {
    const float t = inside_a / (inside_a - inside_b);
    if (inside_a < 0) from = std::max(from, inside_b < 0 ? 2.0F : t);
    if (inside_a >= 0 && inside_b < 0) to = std::min(to, t);
  };
  for (int axis = 0; axis < 2; ++axis) {
    const float xa = a[axis] * place.height + off[axis] * a.z, xb = b[axis] * place.height + off[axis] * b.z;
    for (const float sign : {-1.0F, 1.0F})
      cut(window[axis] * (a.z + lift) + sign * xa, window[axis] * (b.z + lift) + sign * xb);
  }
  if (grid.cones && grid.cones->end && !at.meets_end) cut(place.height - a.z, place.height - b.z);
  return {.start = from > 0 ? glm::mix(a, b, from) : a,
          .end = to < 1 ? glm::mix(a, b, to) : b,
          .far_start = from > 0 ? glm::mix(far_a, far_b, from) : far_a,
          .far_end = to < 1 ? glm::mix(far_a, far_b, to) : far_b,
          .passes_at_start = passing.behind[0] && from == passing.share,
          .passes_at_end = passing.behind[1] && to == passing.share,
          .is_empty = from > to || (passing.behind[0] && passing.behind[1])};
}

}  // namespace

std::optional<float> exact_multiplicity(const EdgeTable& edges, std::size_t edge, const ClusterSample& at,
                                        OpenJudge& judge) {
  float k = 0;
  for (const std::size_t first : {std::size_t{kNormal1X}, std::size_t{kNormal2X}}) {
    const auto plane = std::bit_cast<std::uint32_t>(edges[first + kPlane1 - kNormal1X][edge]);
    if (edges[first + kOffsetError1 - kNormal1X][edge] < 0 || plane == at.plane) continue;
    const glm::dvec3 n(edges[first][edge], edges[first + 1][edge], edges[first + 2][edge]);
    const glm::dvec3 towards = judge.normal_towards(at, plane);  // a plane has the index of a triangle in it
    const double side = glm::dot(n, towards);  // the cosine between both is ±1 to a thousandth, unless one of them is
                                               // unknown
    if (!(std::abs(side) > 0.5 * glm::length(n) * glm::length(towards))) return std::nullopt;
    k += side > 0 ? 1.0F : -1.0F;
  }
  return k;
}

int side_of_direction(const PreciseInput& in, const glm::dvec3& l) {
  const auto [from, to] = ends_of(in.of, in.edge);
  const glm::dvec3 a = from - glm::dvec3(in.at.p), b = to - glm::dvec3(in.at.p);
  const double side = glm::dot(l, glm::cross(a, b));
  // Error bound as in visibility::certainly_meets.
  const double error = 0x1p-46 * glm::length(l) * glm::length(a) * glm::length(b);
  if (std::abs(side) <= error) return 0;
  // Seen from above, where the light is, the grid is mirrored.
  return (side > 0) == (in.of.grid.side < 0) ? 1 : -1;
}

std::optional<ProjectedEdge> place_edge(const PreciseInput& in, Open& open) {
  const LightGrid& grid = in.of.grid;
  const ClusterSample& at = in.at;
  const EdgeTable& edges = in.of.edges;
  const std::size_t edge = in.edge;
  const Placing& place = at.on_light;
  const auto direction_to = [&](float x, float y, float h) {
    return turned(grid, at, {x - at.in_grid.x, y - at.in_grid.y, at.in_grid.z - h});
  };
  const Direction a = direction_to(edges[kAx][edge], edges[kAy][edge], edges[kAh][edge]);
  const Direction b = direction_to(edges[kBx][edge], edges[kBy][edge], edges[kBh][edge]);
  const float far = edges[kFar][edge] + at.far, far_a = far_of(grid, place, a, far),
              far_b = far_of(grid, place, b, far);
  const PassingEdge passing = !in.settled && at.meets_end ? pass_disk({grid, at}, ends_of(in.of, edge)) : PassingEdge();
  const WindowPart part =
      in.settled ? WindowPart{a, b, far_a, far_b} : cut_to_window(grid, at, a, b, far_a, far_b, passing);
  if (part.is_empty || in.k == 0) return std::nullopt;
  if (!in.settled && (part.start.z < place.through_p * part.far_start || part.end.z < place.through_p * part.far_end)) {
    open.pixel = true;
    return std::nullopt;
  }
  const glm::vec2 start = part.passes_at_start ? passing.place : appears(place, part.start),
                  end = part.passes_at_end ? passing.place : appears(place, part.end);
  const glm::vec2 projected_a = in.projected ? (*in.projected)[0] : start;
  const glm::vec2 projected_b = in.projected ? (*in.projected)[1] : end;
  const float foot_a = glm::length(projected_a - place.foot), foot_b = glm::length(projected_b - place.foot);
  ProjectedEdge edge_on_light =
      project_edge(grid, projected_a, projected_b, error_of(place, part.far_start, part.start.z, foot_a),
                   error_of(place, part.far_end, part.end.z, foot_b));
  edge_on_light.may_be_cut = std::max(far_a, far_b) > far;
  return edge_on_light;
}

template <typename Counter>
void scatter_precisely(const PreciseInput& in, const Changes<Counter>& changes, Open& open) {
  const std::optional<ProjectedEdge> placed = place_edge(in, open);
  if (!placed) return;
  const ProjectedEdge& edge_on_light = *placed;
  const LightGrid& grid = in.of.grid;
  const float k = in.k;
  Marks marks(grid, open);
  for (const auto& [end, error] : {std::pair(edge_on_light.near, edge_on_light.error_near),
                                   std::pair(edge_on_light.far, edge_on_light.error_far)}) {
    const float row = std::round(end.y);
    if (std::abs(end.y - row) < error) marks.near(row, end.x, 1.2F * error * (1 + edge_on_light.steep));
  }
  const auto jump = static_cast<Counter>((edge_on_light.near.y < edge_on_light.far.y) == edge_on_light.turn ? k : -k);
  const float from = cross_rows(in, edge_on_light, jump, changes, marks);
  if (passes_corner(grid, edge_on_light)) marks.corner();
  const float a = edge_on_light.a().x, b = edge_on_light.b().x;
  if ((a < -0.5F) == (b < -0.5F)) return;
  cross_left_side(in, edge_on_light, from, static_cast<Counter>(a < b ? k : -k), changes, marks);
}

template void scatter_precisely(const PreciseInput&, const Changes<std::int8_t>&, Open&);
template void scatter_precisely(const PreciseInput&, const Changes<std::int16_t>&, Open&);
template void scatter_precisely(const PreciseInput&, const Changes<std::int32_t>&, Open&);

}  // namespace penumbra::volumes
