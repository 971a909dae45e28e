// SPDX-License-Identifier: Apache-2.0
// The five patterns of light samples on the unit square. All are deterministic: integers, hashes and exact fractions.

#include "visibility/sample_patterns.hpp"

#include "base/error.hpp"

#include <array>
#include <cmath>

namespace penumbra::visibility {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  return (x << 16) | (x >> 16);
}

/// Owen scrambling by a hash: Laine, Karras, "Stratified sampling for stochastic transparency" (2011), section 3.1, as
/// in Burley, "Practical hash-based Owen scrambling" (JCGT 2020): on reversed bits, x ^= x · even lets each bit depend
/// only on the bits below it, which is what makes it a nested (Owen) scramble of the bits in their right order.
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverse_bits(x);
}

/// Returns Sobol's second dimension (primitive polynomial x + 1): direction numbers v₀ = ½, vᵢ = vᵢ₋₁ ⊕ vᵢ₋₁ / 2. The
/// first dimension is the radical inverse.
std::uint32_t sobol_second(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t direction = 0x80000000u; index != 0; index >>= 1, direction ^= direction >> 1) {
    if (index & 1u) result ^= direction;
  }
  return result;
}

std::vector<glm::dvec2> sobol(std::uint32_t count, std::uint32_t seed) {
  std::vector<glm::dvec2> samples(count);
  const std::uint32_t seed_x = hash(seed, 0, 0), seed_y = hash(seed, 1, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    samples[i] = {to_unit(owen_scramble(reverse_bits(i), seed_x)), to_unit(owen_scramble(sobol_second(i), seed_y))};
  }
  return samples;
}

/// Returns one point in each of `count` strata of equal area. Rows hold ⌊count/rows⌋ or ⌈count/rows⌉ strata and have
/// heights in proportion, so that no count needs rounding; if rows divide count the strata are the cells of an L × B
/// grid.
std::vector<glm::dvec2> jittered(const SampleLayout& layout, std::uint32_t seed) {
  std::vector<glm::dvec2> samples;
  samples.reserve(layout.count);
  for (std::uint32_t row = 0; row < layout.rows; ++row) {
    const std::uint32_t begin = row * layout.count / layout.rows, end = (row + 1) * layout.count / layout.rows;
    const double in_row = end - begin;
    for (std::uint32_t i = begin; i < end; ++i) {
      const double x = to_unit(hash(seed, i, 0)), y = to_unit(hash(seed, i, 1));
      samples.emplace_back(((i - begin) + x) / in_row, (begin + in_row * y) / layout.count);
    }
  }
  return samples;
}

/// Returns square tiles of four points each, one in every row and column of the tile's 4 x 4 cells: a rotated square
/// ("rotated grid supersampling"). 8 x 8 tiles are the pattern of Eisemann et al. 2009, "Casting shadows in real time",
/// section 5.2.3.2.
std::vector<glm::dvec2> turned_squares(std::uint32_t rows, std::uint32_t columns) {
  constexpr std::array<glm::dvec2, 4> kSquare{{{1.5, 0.5}, {3.5, 1.5}, {0.5, 2.5}, {2.5, 3.5}}};
  std::vector<glm::dvec2> samples;
  samples.reserve(4 * std::size_t{rows} * columns);
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      for (const glm::dvec2& at : kSquare) {
        samples.emplace_back((column + at.x / 4) / columns, (row + at.y / 4) / rows);
      }
    }
  }
  return samples;
}

/// Returns the layout of rotated squares: at least ⌈count / 4⌉ tiles, in as many rows as the square root of their
/// number, rounded; for LxB, enough rows and columns of tiles, of two by two points each, for L rows of B points.
SampleLayout tiles_of(const SampleRequest& request, std::uint32_t count) {
  const auto tiles = (count + 3) / 4;
  const auto rows = request.rows != 0 ? (request.rows + 1) / 2
                                      : static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(tiles))));
  const std::uint32_t columns = request.rows != 0 ? (request.columns + 1) / 2 : (tiles + rows - 1) / rows;
  if (4 * std::uint64_t{rows} * columns > kMaxLightSamples) {
    throw UsageError(
        "light samples: pattern rgss makes {} x {} squares of four, {} light samples; 1 to {} are possible", rows,
        columns, 4 * std::uint64_t{rows} * columns, kMaxLightSamples);
  }
  return {4 * rows * columns, rows, columns};
}

}  // namespace

const char* name_of(SamplePattern pattern) {
  switch (pattern) {
    case SamplePattern::rows:
      return "rows";
    case SamplePattern::grid:
      return "grid";
    case SamplePattern::sobol:
      return "sobol";
    case SamplePattern::jittered:
      return "jittered";
    case SamplePattern::rgss:
      return "rgss";
  }
  return "?";
}

SampleLayout layout_of(const SampleRequest& request) {
  const bool explicit_rows = request.rows != 0 || request.columns != 0;
  const std::uint64_t wanted =
      explicit_rows ? static_cast<std::uint64_t>(request.rows) * request.columns : request.count;
  if (wanted == 0 || wanted > kMaxLightSamples) {
    if (explicit_rows) {
      throw UsageError("light samples: {}x{} are {} samples; 1 to {} are possible", request.rows, request.columns,
                       wanted, kMaxLightSamples);
    }
    throw UsageError("light samples: {} requested; 1 to {} are possible", wanted, kMaxLightSamples);
  }
  const auto count = static_cast<std::uint32_t>(wanted);
  if (request.pattern == SamplePattern::rgss) return tiles_of(request, count);
  if (explicit_rows) return {count, request.rows, request.columns};
  const auto rows = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(count))));
  const std::uint32_t columns = (count + rows - 1) / rows;
  if (request.pattern == SamplePattern::rows || request.pattern == SamplePattern::grid) {
    return {rows * columns, rows, columns};
  }
  return {count, rows, columns};
}

double row_shift_of(std::uint32_t row) {
  // Multiples of the golden ratio modulo 1 (40503 / 2¹⁶) spread any number of rows evenly over a cell; 40503 is odd, so
  // no two of 65536 rows share a shift and −0.5 itself is reached by row 32768 only.
  return ((row * 40503u + 32768u) % 65536u - 32768.0) / 65536.0;
}

std::vector<glm::dvec2> unit_square_samples(const SampleRequest& request) {
  const SampleLayout layout = layout_of(request);
  if (request.pattern == SamplePattern::sobol) return sobol(layout.count, request.seed);
  if (request.pattern == SamplePattern::jittered) return jittered(layout, request.seed);
  if (request.pattern == SamplePattern::rgss) return turned_squares(layout.rows, layout.columns);
  std::vector<glm::dvec2> samples;
  samples.reserve(layout.count);
  for (std::uint32_t row = 0; row < layout.rows; ++row) {
    const double shift = request.pattern == SamplePattern::rows ? row_shift_of(row) : 0.0;
    for (std::uint32_t column = 0; column < layout.columns; ++column) {
      samples.emplace_back((column + 0.5 + shift) / layout.columns, (row + 0.5) / layout.rows);
    }
  }
  return samples;
}

}  // namespace penumbra::visibility
