#include "reference/form_factor_sum.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra::reference {
namespace {

/// What of a convex polygon has sign · (t − border) ≥ 0.
std::vector<glm::dvec2> clip(const std::vector<glm::dvec2>& polygon, double border, double sign) {
  std::vector<glm::dvec2> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = sign * (a.y - border), at_b = sign * (b.y - border);
    if (at_a >= 0) inside.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) inside.emplace_back(a.x + at_a / (at_a - at_b) * (b.x - a.x), border);
  }
  return inside;
}

}  // namespace

void FormFactorSum::add(const Trapezoid& part) {
  const std::array<glm::dvec2, 4> corners{
      glm::dvec2(part.s0, part.low0), {part.s1, part.low1}, {part.s1, part.high1}, {part.s0, part.high0}};
  if (texture_ == nullptr) {
    sum_ += seen_.part(corners);
  } else {
    add_texels(corners);
  }
}

void FormFactorSum::add_whole() {
  if (texture_ == nullptr) {
    sum_ += seen_.whole();
    return;
  }
  const std::uint32_t columns = texture_->width;
  for (std::uint32_t x = 0; x < columns; ++x) {
    add({2.0 * x / columns - 1, 2.0 * (x + 1) / columns - 1, -1, -1, 1, 1});
  }
}

/// Cut in bands at the borders between rows of texels, from the top, where row 0 is.
void FormFactorSum::add_texels(const std::array<glm::dvec2, 4>& corners) {
  const auto rows = static_cast<double>(texture_->height);
  const auto [low, high] = std::minmax({corners[0].y, corners[1].y, corners[2].y, corners[3].y});
  const double middle = (corners[0].x + corners[1].x) / 2;
  const auto row_of = [&](double t) { return std::clamp(std::floor((1 - t) / 2 * rows), 0.0, rows - 1); };
  const auto first = static_cast<std::uint32_t>(row_of(high)), last = static_cast<std::uint32_t>(row_of(low));
  std::vector<glm::dvec2> rest(corners.begin(), corners.end());
  for (std::uint32_t row = first; row <= last && !rest.empty(); ++row) {
    const double border = 1 - 2.0 * (row + 1) / rows;
    const std::vector<glm::dvec2> band = row == last ? rest : clip(rest, border, 1);
    const std::size_t texel = texture_->texel_at({middle, 1 - (2.0 * row + 1) / rows});
    sum_ += seen_.part(band) * glm::dvec3(texture_->colors[texel]);
    if (row != last) rest = clip(rest, border, -1);
  }
}

}  // namespace penumbra::reference
