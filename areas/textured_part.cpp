// SPDX-License-Identifier: Apache-2.0
// Luminance of a light's texture over trapezoids between two of its rows, as a fraction of the whole, from prefix sums.

#include "areas/textured_part.hpp"

#include "areas/texture_measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace penumbra::areas {
namespace {

/// Returns the texture with rows and columns exchanged: rows from the lowest become columns, and a row's texels from
/// left to right become a column's texels from below.
visibility::LightTexture turned(const visibility::LightTexture& texture) {
  visibility::LightTexture result;
  result.width = texture.height;
  result.height = texture.width;
  result.luminance.resize(texture.luminance.size());
  for (std::uint32_t y = 0; y < texture.height; ++y) {
    for (std::uint32_t x = 0; x < texture.width; ++x) {
      result.luminance[std::size_t{texture.width - 1 - x} * texture.height + y] =
          texture.luminance[std::size_t{texture.height - 1 - y} * texture.width + x];
    }
  }
  return result;
}

}  // namespace

struct TexturedPart::Rows {
  TextureColumns columns;  // columns of the turned texture: the light's rows, upward
  double integral;
};

TexturedPart::TexturedPart(const visibility::LightTexture& texture) {
  TextureColumns columns(turned(texture));
  const double integral = columns.integral().get_d();
  contrast_ = 4 * *std::ranges::max_element(texture.luminance) / integral;
  rounding_ = 16.0 * (texture.width + texture.height) * 0x1p-53 * contrast_;
  rows_ = std::make_unique<const Rows>(Rows{std::move(columns), integral});
}

TexturedPart::~TexturedPart() = default;
TexturedPart::TexturedPart(TexturedPart&&) noexcept = default;
TexturedPart& TexturedPart::operator=(TexturedPart&&) noexcept = default;

double TexturedPart::share_of(const LevelTrapezoid& part) const {
  const double height = part.high - part.low;
  if (!(height > 0)) return 0;
  const auto rows = static_cast<double>(rows_->columns.width());
  const auto row_of = [&](double t) { return std::clamp(std::floor((t + 1) / 2 * rows), 0.0, rows - 1); };
  const auto between = [&](double low, double high, double t) { return low + (t - part.low) / height * (high - low); };
  TextureMeasure<double> measure(rows_->columns);
  double sum = 0, from = part.low;
  for (double row = row_of(part.low), last = row_of(part.high); row <= last; ++row) {
    const double to = row == last ? part.high : std::min(2 * (row + 1) / rows - 1, part.high);
    if (!(to > from)) continue;
    measure.enter_strip((2 * row + 1) / rows - 1);
    const auto side = [&](double low, double high) {
      return ActiveEdge<double>{nullptr, 0, 0, 0, between(low, high, from), between(low, high, to)};
    };
    sum += (to - from) * measure.between(side(part.low_left, part.high_left), side(part.low_right, part.high_right));
    from = to;
  }
  return sum / rows_->integral;
}

}  // namespace penumbra::areas
