// SPDX-License-Identifier: Apache-2.0
#pragma once

// Runs the ray caster over a whole picture and keeps its masks.

#include "reference/methods.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/method.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::tests {

struct Masks {
  std::size_t words_per_pixel = 0;
  std::vector<std::uint32_t> words;
  std::vector<float> visibility;

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t pixel) const {
    return std::span(words).subspan(pixel * words_per_pixel, words_per_pixel);
  }
  [[nodiscard]] std::uint32_t word(std::size_t pixel, std::size_t i) const {
    return words[pixel * words_per_pixel + i];
  }
  [[nodiscard]] bool visible(std::size_t pixel, std::size_t sample) const {
    return ((word(pixel, sample / 32) >> (sample % 32)) & 1u) != 0;
  }
  [[nodiscard]] std::uint32_t visible_count(std::size_t pixel) const {
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < words_per_pixel; ++i)
      count += static_cast<std::uint32_t>(std::popcount(word(pixel, i)));
    return count;
  }
};

inline std::size_t differing_bits(const Masks& a, const Masks& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.words.size(); ++i)
    count += static_cast<std::size_t>(std::popcount(a.words[i] ^ b.words[i]));
  return count;
}

/// Returns the masks of all pixels. `rows_at_once` 0: as many rows as the method takes.
inline Masks trace(const visibility::SceneFloats& floats, const visibility::Light& light,
                   const visibility::ViewSamples& samples, const visibility::MethodOptions& options = {},
                   std::uint32_t rows_at_once = 0) {
  const auto method = reference::make_ray_traced(options);
  method->prepare_mesh(floats);
  method->prepare_light(light);
  method->prepare_view(samples);
  Masks masks;
  masks.words_per_pixel = light.words_per_mask();
  masks.words.resize(samples.size() * masks.words_per_pixel);
  masks.visibility.resize(samples.size());
  const std::uint32_t rows = rows_at_once != 0 ? rows_at_once : method->max_tile_rows();
  for (std::uint32_t first = 0; first < samples.height; first += rows) {
    const visibility::Tile tile{first, std::min(rows, samples.height - first)};
    method->evaluate(tile);
    const std::size_t pixel = std::size_t{first} * samples.width, pixels = std::size_t{tile.row_count} * samples.width;
    method->read_masks(std::span(masks.words).subspan(pixel * masks.words_per_pixel, pixels * masks.words_per_pixel));
    method->read_visibility(std::span(masks.visibility).subspan(pixel, pixels));
  }
  return masks;
}

inline Masks trace(const Stage& setup, const visibility::MethodOptions& options = {}, std::uint32_t rows_at_once = 0) {
  return trace(setup.floats, setup.light, setup.samples, options, rows_at_once);
}

}  // namespace penumbra::tests
