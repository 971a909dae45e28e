// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/options.hpp"
#include "render/device.hpp"
#include "visibility/method.hpp"
#include "visibility/method_options.hpp"

#include <cstdint>

namespace penumbra::maps {

enum class SoftPrecision : std::uint8_t { fp32, fp16 };
enum class SoftForm : std::uint8_t { gather, scatter };
enum class SoftFilter : std::uint8_t { linear, nearest };
enum class SoftPatches : std::uint8_t { top, bottom };
enum class SoftSelf : std::uint8_t { none, backproject };

/// Options of soft-shadow-map in addition to those of all methods with a map.
struct SoftSettings {
  std::uint32_t receiver_size;  ///< on a side of the map of receivers
  std::uint32_t passes;         ///< 2: a second pass with the farthest surfaces
  SoftPatches patches;          ///< bottom: the farthest surfaces alone
  SoftPrecision precision;
  SoftForm form;
  SoftFilter filter;
  SoftSelf self;
};

/// Name of the counter of pixels on objects that cast shadow.
inline constexpr const char* kPixelsOnOccluders = "pixelsOnOccluders";

/// Throws UsageError if options exclude each other.
SoftSettings soft_settings(const visibility::ParsedOptions& parsed);

}  // namespace penumbra::maps
