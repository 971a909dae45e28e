// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/atomic_file.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <span>

namespace penumbra::visibility {

// A file of `--bits`, format penumbra-bits/1, little-endian: the result of every pair, for external verification.
//
//     ASCII          "penumbra-bits/1 W H N\n"
//     3 double       origin of the scene floats
//     N × 3 float    light samples, relative to the origin; for a sun, directions
//     W·H times, in scan-line order:
//       3 float      view sample, relative to the origin (0 for background)
//       1 int32      carrying triangle, −1 background
//       ⌈N/32⌉ uint32  bit j mod 32 of word ⌊j/32⌋ is set iff light sample j is visible

/// Writes a file of `--bits` in bands of rows, as tiles are finished. The file appears complete with commit() or not at
/// all. `samples` must outlive the writer.
class BitsWriter {
 public:
  /// Throws UsageError for a sphere light: its points differ from pixel to pixel.
  BitsWriter(const std::filesystem::path& path, const glm::dvec3& origin, const ViewSamples& samples,
             const Light& light);

  /// Appends the masks of the next pixels in scan-line order, words_per_mask() words each.
  void append(std::span<const std::uint32_t> masks);

  /// To be called after the last pixel; see the functions of the same names in AtomicFile.
  void settle();
  void commit();

 private:
  const ViewSamples& samples_;
  std::uint32_t words_per_mask_;
  std::size_t next_pixel_ = 0;
  AtomicFile file_;
};

}  // namespace penumbra::visibility
