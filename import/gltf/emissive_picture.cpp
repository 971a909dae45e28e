// SPDX-License-Identifier: Apache-2.0
// Means of pictures over triangles: triangles are clipped to rows and texels (Sutherland and Hodgman), and large ones
// are sampled.

#include "import/gltf/emissive_picture.hpp"

#include "base/image.hpp"
#include "scenes/texel_number.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace penumbra::import {
namespace {

/// A convex outline with few corners.
struct Outline {
  std::array<glm::dvec2, 8> corners{};
  std::size_t count = 0;
  void add(const glm::dvec2& corner) {
    if (count < corners.size()) corners[count++] = corner;
  }
  [[nodiscard]] std::span<const glm::dvec2> all() const { return std::span(corners).first(count); }
};

/// Returns the part of a convex outline where the coordinate `axis` is at least (or at most) `limit`: Sutherland and
/// Hodgman.
Outline cut(const Outline& outline, glm::length_t axis, double limit, bool at_least) {
  Outline kept;
  for (std::size_t i = 0; i < outline.count; ++i) {
    const glm::dvec2 &a = outline.corners[i], &b = outline.corners[(i + 1) % outline.count];
    const bool a_in = at_least ? a[axis] >= limit : a[axis] <= limit;
    const bool b_in = at_least ? b[axis] >= limit : b[axis] <= limit;
    if (a_in) kept.add(a);
    if (a_in != b_in) {
      glm::dvec2 crossing = a + (limit - a[axis]) / (b[axis] - a[axis]) * (b - a);
      crossing[axis] = limit;
      kept.add(crossing);
    }
  }
  return kept;
}

double area_of(const Outline& outline) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < outline.count; ++i) {
    const glm::dvec2 a = outline.corners[i] - outline.corners[0], b = outline.corners[i + 1] - outline.corners[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

struct Range {
  double first, last;
};

/// Returns the smallest and the largest coordinate of an outline.
Range range_of(const Outline& outline, glm::length_t axis) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const glm::dvec2& corner : outline.all()) {
    range.first = std::min(range.first, corner[axis]);
    range.last = std::max(range.last, corner[axis]);
  }
  return range;
}

/// Returns the integers between which an outline lies: it meets cells first … last − 1.
Range cells_of(const Outline& outline, glm::length_t axis) {
  const Range range = range_of(outline, axis);
  return {std::floor(range.first), std::ceil(range.last)};
}

class Texels {
 public:
  Texels(const scenes::Picture& picture, const scenes::PictureUse& use) : picture_(picture), use_(use) {}
  /// Returns the colour of the cell that begins at (x, y), in whole texels from the picture's top left.
  [[nodiscard]] glm::dvec3 at(double x, double y) const {
    static const std::array<double, 256> linear = [] {
      std::array<double, 256> values{};
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = linear_of_srgb(static_cast<double>(i) / 255);
      return values;
    }();
    const auto& texel = picture_.texels[scenes::texel_number(y, picture_.height, use_.wrap_t) * picture_.width +
                                        scenes::texel_number(x, picture_.width, use_.wrap_s)];
    return {linear[texel[0]], linear[texel[1]], linear[texel[2]]};
  }

 private:
  const scenes::Picture& picture_;
  const scenes::PictureUse& use_;
};

/// Samples at the centres of steps² equal parts.
glm::dvec3 sampled_mean(const Texels& texels, const Outline& triangle, int steps) {
  glm::dvec3 sum(0);
  const glm::dvec2 u = (triangle.corners[1] - triangle.corners[0]) / double(steps);
  const glm::dvec2 v = (triangle.corners[2] - triangle.corners[0]) / double(steps);
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; i + j < steps; ++j) {
      const auto add = [&](double s, double t) {
        const glm::dvec2 at = triangle.corners[0] + (i + s) * u + (j + t) * v;
        sum += texels.at(std::floor(at.x), std::floor(at.y));
      };
      add(1 / 3.0, 1 / 3.0);
      if (i + j + 1 < steps) add(2 / 3.0, 2 / 3.0);
    }
  }
  return sum / (double(steps) * steps);
}

struct Sum {
  glm::dvec3 color{0};
  double area = 0;
  void add(const glm::dvec3& texel, double share) {
    color += share * texel;
    area += share;
  }
};

/// Adds the texels of one row; `row` is the part of the row within the triangle. Texels between the ends of its upper
/// and lower border are covered completely.
void add_row(const Texels& texels, Outline row, double y, Sum& sum) {
  Range whole{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const double border : {y, y + 1}) {
    Range at{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const glm::dvec2& corner : row.all()) {
      if (corner.y == border) at = {std::min(at.first, corner.x), std::max(at.last, corner.x)};
    }
    whole = {std::max(whole.first, at.first), std::min(whole.last, at.last)};
  }
  whole = {std::ceil(whole.first), std::floor(whole.last)};
  const Range columns = cells_of(row, 0);
  for (double x = columns.first; x < columns.last && row.count >= 3; ++x) {
    if (x == whole.first && whole.last > whole.first) {
      for (; x < whole.last; ++x) sum.add(texels.at(x, y), 1);
      row = cut(row, 0, x, true);
      if (row.count < 3 || x >= columns.last) break;
    }
    sum.add(texels.at(x, y), area_of(cut(row, 0, x + 1, false)));
    row = cut(row, 0, x + 1, true);
  }
}

}  // namespace

glm::dvec3 PictureMeans::over(const scenes::PictureUse& use, std::span<const PicturedTriangle> triangles) {
  glm::dvec3 sum(0);
  double area = 0;
  for (const PicturedTriangle& triangle : triangles) {
    if (!(triangle.area > 0)) continue;
    std::array<double, 9> key{double(use.picture), double(int(use.wrap_s)), double(int(use.wrap_t))};
    for (std::size_t k = 0; k < 3; ++k) {
      key[3 + 2 * k] = triangle.places[k].x;
      key[4 + 2 * k] = triangle.places[k].y;
    }
    const auto [known, is_new] = known_.try_emplace(key);
    if (is_new) known->second = of_triangle(use, triangle.places);
    sum += triangle.area * known->second;
    area += triangle.area;
  }
  return area > 0 ? sum / area : glm::dvec3(0);
}

glm::dvec3 PictureMeans::of_triangle(const scenes::PictureUse& use, const std::array<glm::dvec2, 3>& places) {
  const scenes::Picture& picture = pictures_[use.picture];
  const Texels texels(picture, use);
  const glm::dvec2 size(picture.width, picture.height);
  Outline triangle;
  for (const glm::dvec2& place : places) {
    glm::dvec2 at = place * size;
    // Files store single precision: a coordinate that is within its rounding of a texel border is taken as that border.
    for (glm::length_t axis = 0; axis < 2; ++axis) {
      const double rounding =
          4 * static_cast<double>(std::numeric_limits<float>::epsilon()) * std::max(size[axis], std::abs(at[axis]));
      if (const double whole = std::round(at[axis]); std::abs(at[axis] - whole) <= rounding) at[axis] = whole;
    }
    triangle.add(at);
  }
  // A repeating picture, mirrored or not, is unchanged by a shift of whole periods.
  for (glm::length_t axis = 0; axis < 2; ++axis) {
    if ((axis == 0 ? use.wrap_s : use.wrap_t) == scenes::PictureUse::Wrap::clamp) continue;
    const double periods = 2 * size[axis] * std::floor(range_of(triangle, axis).first / (2 * size[axis]));
    for (std::size_t k = 0; k < 3; ++k) triangle.corners[k][axis] -= periods;
  }
  const glm::dvec2 middle = (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0;
  const glm::dvec3 at_middle = texels.at(std::floor(middle.x), std::floor(middle.y));
  if (area_of(triangle) == 0) return at_middle;
  const Range rows = cells_of(triangle, 1), columns = cells_of(triangle, 0);
  const double cells = (rows.last - rows.first) * (columns.last - columns.first);
  constexpr double kMostCells = 1 << 22, kFarthest = 1 << 30;
  const bool far = std::max({std::abs(rows.first), std::abs(rows.last), std::abs(columns.first),
                             std::abs(columns.last)}) > kFarthest;
  if (far || !(cells <= std::min(kMostCells, cells_left_))) {
    const int steps = cells_left_ > 0 ? 1024 : 64;
    cells_left_ -= steps * steps;
    return sampled_mean(texels, triangle, steps);
  }
  cells_left_ -= cells;
  Sum sum;
  for (double y = rows.first; y < rows.last; ++y) {
    const Outline row = cut(cut(triangle, 1, y, true), 1, y + 1, false);
    if (row.count >= 3) add_row(texels, row, y, sum);
  }
  return sum.area > 0 ? sum.color / sum.area : at_middle;
}

}  // namespace penumbra::import
