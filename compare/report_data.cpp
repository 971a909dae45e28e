// SPDX-License-Identifier: Apache-2.0
// Packs the report's numbers for its script: planes of bytes, deflated, as base64.

#include "compare/report_data.hpp"

#include "base/packed.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace penumbra::compare {
namespace {

template <typename Number>
std::string pack_planes(std::span<const Number> numbers) {
  std::vector<std::byte> plane(numbers.size());
  Deflated deflated;
  for (std::size_t place = sizeof(Number); place-- > 0;) {
    std::ranges::transform(numbers, plane.begin(),
                           [&](Number number) { return static_cast<std::byte>(number >> (8 * place) & 0xff); });
    deflated.add(plane);
  }
  return base64(deflated.finish());
}

std::uint16_t radiance_code(float linear) {
  if (!(linear > 0)) return 0;
  // Floats, including denormal ones, lie between 2^−149 and 2^128.
  const double code = 1 + 256 * (std::log2(static_cast<double>(linear)) + 64);
  return static_cast<std::uint16_t>(std::lround(std::clamp(code, 1.0, 32767.0)));
}

/// Number of steps of four codes from one code to another, accurate to two codes. Black stays as dark as possible.
int steps_between(int from, int to) {
  const int away = to - from;
  return away < 0 ? -((1 - away) / 4) : (away + 1) / 4;
}

std::uint16_t folded(int steps) {
  return static_cast<std::uint16_t>(steps < 0 ? -2 * steps - 1 : 2 * steps);
}

}  // namespace

std::string pack_bytes(std::span<const std::byte> bytes) {
  Deflated deflated;
  deflated.add(bytes);
  return base64(deflated.finish());
}

std::string pack_floats(std::span<const float> values) {
  std::vector<std::uint32_t> bits(values.size());
  std::ranges::transform(values, bits.begin(), [](float value) { return std::bit_cast<std::uint32_t>(value); });
  return pack_planes<std::uint32_t>(bits);
}

std::string pack_radiance(std::uint32_t width, std::span<const glm::vec3> linear) {
  std::vector<std::uint16_t> steps(3 * linear.size());
  std::array<std::uint16_t, 3> left{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    if (i % width == 0) left = {};
    const std::uint16_t green = radiance_code(linear[i].g);
    const std::array<std::uint16_t, 3> here{green, static_cast<std::uint16_t>(radiance_code(linear[i].r) - green),
                                            static_cast<std::uint16_t>(radiance_code(linear[i].b) - green)};
    for (std::size_t plane = 0; plane < 3; ++plane) {
      steps[plane * linear.size() + i] = static_cast<std::uint16_t>(here[plane] - left[plane]);
    }
    left = here;
  }
  return pack_planes<std::uint16_t>(steps);
}

std::string pack_radiance_over(std::span<const glm::vec3> reference, std::span<const glm::vec3> linear) {
  std::vector<std::uint16_t> steps(3 * linear.size());
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const int green = steps_between(radiance_code(reference[i].g), radiance_code(linear[i].g));
    const int red = steps_between(radiance_code(reference[i].r) + 4 * green, radiance_code(linear[i].r));
    const int blue = steps_between(radiance_code(reference[i].b) + 4 * green, radiance_code(linear[i].b));
    steps[i] = folded(green);
    steps[linear.size() + i] = folded(red);
    steps[2 * linear.size() + i] = folded(blue);
  }
  return pack_planes<std::uint16_t>(steps);
}

}  // namespace penumbra::compare
