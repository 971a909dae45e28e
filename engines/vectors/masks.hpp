// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/light_grid.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

/// Masks of visible light samples, and the samples left open.
namespace penumbra::vectors {

/// Returns the number of words of a mask, sixteen light samples each.
inline std::size_t mask_words(const LightGrid& grid) {
  return grid.tiles ? grid.tiles->tile_count() : std::size_t{grid.columns} * grid.padded_rows / 16;
}
/// Returns the bit of a light sample: its slot; for samples in rows column · padded_rows + row.
inline std::size_t mask_bit(const LightGrid& grid, std::uint32_t light_sample) {
  if (grid.tiles) return grid.tiles->slot_of[light_sample];
  return std::size_t{light_sample % grid.columns} * grid.padded_rows + light_sample / grid.columns;
}

/// Light samples of a view sample that float arithmetic left open.
struct Open {
  bool pixel = false;                        ///< all light samples are open
  bool corner = false;                       ///< the number of triangles on the segment to the light's corner is open
  std::vector<std::uint32_t> rows, samples;  ///< rows of light samples; light samples; may contain duplicates

  void clear() {
    pixel = corner = false;
    rows.clear();
    samples.clear();
  }
  [[nodiscard]] bool any() const { return pixel || !rows.empty() || !samples.empty(); }
};

/// The visible light samples of a view sample: their number, and, unless all or none are visible, their bits
/// (mask_words() words).
struct SampleMask {
  std::uint16_t* bits = nullptr;
  std::uint32_t visible = 0;

  /// Sets `visible` from the bits of the first `words` words.
  void count(std::size_t words) {
    visible = 0;
    std::size_t i = 0;
    for (; i + 4 <= words; i += 4) {
      std::uint64_t four = 0;
      std::memcpy(&four, bits + i, sizeof four);
      visible += static_cast<std::uint32_t>(std::popcount(four));
    }
    for (; i < words; ++i) visible += static_cast<std::uint32_t>(std::popcount(bits[i]));
  }
};

/// The light point centre + s u + t v is above the carrier's plane where A s + B t + C > 0.
struct HorizonLine {
  glm::dvec3 above{0};  ///< (A, B, C), in double
  glm::dvec3 error{0};  ///< largest errors of (A, B, C)
};

/// Decides by exact predicates the questions that float arithmetic left open.
class OpenJudge {
 public:
  virtual ~OpenJudge() = default;
  /// Returns the number of triangles that the segment from the view sample to a light sample meets.
  virtual std::uint32_t depth(const GridSample& sample, std::uint32_t light_sample) = 0;
  /// Returns the number of triangles strictly between the view sample and the exact point centre + s u + t v of the
  /// light's plane; nullopt if double does not determine the triangles to test.
  virtual std::optional<std::uint32_t> depth_in_plane(const GridSample& sample, const glm::dvec2& st) = 0;
  /// Returns the vector from p to a light sample, in scene floats, not scaled; for a sun a direction of arbitrary
  /// length.
  virtual glm::dvec3 direction_to(const GridSample& sample, std::uint32_t light_sample) = 0;
  virtual HorizonLine horizon(const GridSample& sample) = 0;
  /// Returns the triangle's normal, of any length, oriented to p's side; 0 if p is in its plane, or if the triangle is
  /// so thin that its normal is not certain in double.
  virtual glm::dvec3 normal_towards(const GridSample& sample, std::uint32_t triangle) = 0;
  virtual void decide(const GridSample& sample, const Open& open, SampleMask& mask) = 0;
};

}  // namespace penumbra::vectors
