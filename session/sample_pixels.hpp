// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::session {

/// Returns the pixels chosen by `--sample-pixels` among `pixels` (indices, ascending): "all"; a number N, evenly
/// spaced; or "x,y;x,y…", those among `pixels`. Throws UsageError for any other text, or a pixel outside the image.
std::vector<std::uint32_t> sample_pixels(const std::vector<std::uint32_t>& pixels, const std::string& choice,
                                         std::uint32_t width, std::uint32_t height);

}  // namespace penumbra::session
