#include "import/gltf/emissive_picture.hpp"

#include "base/image.hpp"
#include "scenes/texel_number.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace penumbra::scenes {
namespace {

using Outline = std::vector<glm::dvec2>;

/// The part of a convex outline where the coordinate `axis` is at least (or at most) `limit`: Sutherland and Hodgman.
Outline cut(const Outline& outline, glm::length_t axis, double limit, bool at_least) {
  Outline kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const bool a_in = at_least ? a[axis] >= limit : a[axis] <= limit;
    const bool b_in = at_least ? b[axis] >= limit : b[axis] <= limit;
    if (a_in) kept.push_back(a);
    if (a_in != b_in) {
      glm::dvec2 crossing = a + (limit - a[axis]) / (b[axis] - a[axis]) * (b - a);
      crossing[axis] = limit;
      kept.push_back(crossing);
    }
  }
  return kept;
}

double area_of(const Outline& outline) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    const glm::dvec2 a = outline[i] - outline[0], b = outline[i + 1] - outline[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

struct Range {
  double first, last;
};

/// The whole numbers between which an outline lies: cells first … last − 1 meet it.
Range cells_of(const Outline& outline, glm::length_t axis) {
  const auto [low, high] = std::ranges::minmax_element(outline, {}, [axis](const auto& p) { return p[axis]; });
  return {std::floor((*low)[axis]), std::ceil((*high)[axis])};
}

class Texels {
 public:
  Texels(const Picture& picture, const PictureUse& use) : picture_(picture), use_(use) {
    for (std::size_t i = 0; i < linear_.size(); ++i) linear_[i] = linear_of_srgb(static_cast<double>(i) / 255);
  }
  /// The colour of the cell that begins at (x, y), whole numbers of texels from the picture's top left.
  [[nodiscard]] glm::dvec3 at(double x, double y) const {
    const auto& texel = picture_.texels[texel_number(y, picture_.height, use_.wrap_t) * picture_.width +
                                        texel_number(x, picture_.width, use_.wrap_s)];
    return {linear_[texel[0]], linear_[texel[1]], linear_[texel[2]]};
  }

 private:
  const Picture& picture_;
  const PictureUse& use_;
  std::array<double, 256> linear_{};
};

glm::dvec3 sampled_mean(const Texels& texels, const Outline& triangle) {
  constexpr int kSteps = 1024;  // the middles of this many squared equal parts
  glm::dvec3 sum(0);
  const glm::dvec2 u = (triangle[1] - triangle[0]) / double{kSteps}, v = (triangle[2] - triangle[0]) / double{kSteps};
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; i + j < kSteps; ++j) {
      const auto add = [&](double s, double t) {
        const glm::dvec2 at = triangle[0] + (i + s) * u + (j + t) * v;
        sum += texels.at(std::floor(at.x), std::floor(at.y));
      };
      add(1 / 3.0, 1 / 3.0);
      if (i + j + 1 < kSteps) add(2 / 3.0, 2 / 3.0);
    }
  }
  return sum / (double{kSteps} * kSteps);
}

/// Of a triangle in texels.
glm::dvec3 mean_of(const Texels& texels, const Outline& triangle) {
  constexpr double kMostCells = 1 << 22;
  const glm::dvec2 middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
  const Range rows = cells_of(triangle, 1), all = cells_of(triangle, 0);
  if (area_of(triangle) == 0) return texels.at(std::floor(middle.x), std::floor(middle.y));
  if ((rows.last - rows.first) * (all.last - all.first) > kMostCells) return sampled_mean(texels, triangle);
  glm::dvec3 sum(0);
  double area = 0;
  for (double y = rows.first; y < rows.last; ++y) {
    Outline row = cut(cut(triangle, 1, y, true), 1, y + 1, false);
    if (row.size() < 3) continue;
    const Range columns = cells_of(row, 0);
    for (double x = columns.first; x < columns.last; ++x) {
      const double share = area_of(cut(row, 0, x + 1, false));
      sum += share * texels.at(x, y);
      area += share;
      row = cut(row, 0, x + 1, true);
      if (row.size() < 3) break;
    }
  }
  return area > 0 ? sum / area : texels.at(std::floor(middle.x), std::floor(middle.y));
}

}  // namespace

glm::dvec3 mean_over(const Picture& picture, const PictureUse& use, std::span<const PicturedTriangle> triangles) {
  const Texels texels(picture, use);
  const glm::dvec2 size(picture.width, picture.height);
  glm::dvec3 sum(0);
  double area = 0;
  for (const PicturedTriangle& triangle : triangles) {
    Outline places;
    for (const glm::dvec2& place : triangle.places) {
      glm::dvec2 at = place * size;
      // Files hold single precision: an edge between texels is meant where a place is that near to it.
      for (glm::length_t axis = 0; axis < 2; ++axis) {
        const double rounding =
            4 * static_cast<double>(std::numeric_limits<float>::epsilon()) * std::max(size[axis], std::abs(at[axis]));
        if (const double whole = std::round(at[axis]); std::abs(at[axis] - whole) <= rounding) at[axis] = whole;
      }
      places.push_back(at);
    }
    if (!(triangle.area > 0)) continue;
    sum += triangle.area * mean_of(texels, places);
    area += triangle.area;
  }
  return area > 0 ? sum / area : glm::dvec3(0);
}

}  // namespace penumbra::scenes
