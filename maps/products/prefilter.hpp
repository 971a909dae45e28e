// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/prefilter.shared.h"
#include "maps/products/summed_areas.hpp"
#include "render/compute_pass.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::maps {

/// Scheme of means over windows.
enum class PrefilterKind : std::uint32_t {
  table = gpu::kTable,      ///< summed areas in integers: any box, its border texels weighted by their fraction
  pyramid = gpu::kPyramid,  ///< mip levels, interpolated between texels and between levels
  windows = gpu::kWindows,  ///< N-buffer: overlapping squares of the largest power of two that fits into the box
};

/// Function of a texel, see prefilter.shared.h.
struct PrefilterFunction {
  std::uint32_t kind = gpu::kLayer, power = gpu::kPlain;
  float a = 1, b = 0;
  std::uint32_t digits = 24;  ///< number of binary digits stored in a table; 0: the value is 0 or 1
};

struct PrefilterOptions {
  PrefilterKind kind = PrefilterKind::table;
  std::vector<PrefilterFunction> functions{};
  bool of_bits = false;            ///< texels are words of bits; else the maps' depths
  bool slope = false;              ///< squares of layers include the effect of the surface's slope within a texel
  std::uint64_t buffer_bytes = 0;  ///< size limit of a buffer; 0: the device's limit
  bool is_reduced = false;         ///< the size of maps is the default, reduced to what buffers can hold
};

/// Counter of lights whose maps have a reduced size (PrefilterOptions::is_reduced).
inline constexpr const char* kReducedMaps = "reducedMaps";

/// Functions of the texels of one light point's maps, prefiltered: a look-up computes their means over windows of any
/// size by a number of fetches independent of the window (maps/products/prefilter.glsl).
///
/// Tables sum unsigned integers modulo 2³². With b = ⌊32 − 2 log₂ size⌋ bits a texel no box overflows, so a value of
/// more binary digits is cut into limbs of b bits, each with a separate table: sums of 24 digits, or of the 150 needed
/// by an exponential, are exact at any size.
class Prefilter final : public MapProduct {
 public:
  /// Sources of texels. All are recorded before this product.
  struct Sources {
    const MapProduct* nearest = nullptr;  ///< NearestCaster
    const MapProduct* frame = nullptr;    ///< MapFrame
    const MapProduct* bits = nullptr;     ///< one word for each texel of each face; with of_bits
  };
  Prefilter(const render::Device& device, PrefilterOptions options, const Sources& sources);

  /// Throws ResourceError, with the largest possible size, if the device's buffers are too small.
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *table_; }
  [[nodiscard]] std::vector<render::BufferReference> buffers() const override;
  /// Returns the scheme and the number of its buffers.
  [[nodiscard]] std::vector<std::uint32_t> constants(std::uint32_t size, std::uint32_t faces) const override;
  [[nodiscard]] std::uint64_t memory_bytes() const override;
  void add_counters(std::map<std::string, std::uint64_t>& counters) const override;

 private:
  [[nodiscard]] std::uint64_t buffer_bytes() const;
  [[nodiscard]] std::vector<std::uint32_t> value_constants() const;  ///< constants of prefilter_values.glsl
  void record_values(render::Commands& commands, const MapSet& maps, const gpu::PrefilterValuesPush& push);
  void record_levels(render::Commands& commands, const gpu::PrefilterTable& table) const;

  const render::Device* device_;
  PrefilterOptions options_;
  Sources sources_;
  render::ComputePass values_, level_;
  std::optional<render::ComputePass> fitted_values_;  ///< for MapSet::face_table
  SummedAreas sums_;
  std::unique_ptr<render::Buffer> table_;
  std::array<std::unique_ptr<render::Buffer>, gpu::kPrefilterBuffers> images_;
  std::array<std::uint32_t, gpu::kPrefilterBuffers> blocks_{};  ///< number of blocks in each buffer
};

/// Layout of a look-up's data, for maps of this size. Empty if more is needed than `kPrefilterBuffers` buffers of
/// `buffer_bytes` hold.
struct PrefilterLayout {
  gpu::PrefilterTable table;
  std::vector<gpu::PrefilterValue> values;
  std::uint32_t blocks = 0;
};
std::optional<PrefilterLayout> prefilter_layout(const PrefilterOptions& options, std::uint32_t size,
                                                std::uint32_t faces, std::uint64_t buffer_bytes);

/// Returns `size`, or, where buffers of `buffer_bytes` do not hold a look-up's data for it, the largest multiple of 64
/// for which they do; at least 64.
std::uint32_t size_that_fits(const PrefilterOptions& options, std::uint32_t size, std::uint32_t faces,
                             std::uint64_t buffer_bytes);

}  // namespace penumbra::maps
