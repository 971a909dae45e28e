#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::app {

/// Which of the given pixels (indices, ascending) `--sample-pixels` chooses: "all"; a number N, evenly spaced; or
/// "x,y;x,y…", those of them that are among the given. Throws UsageError for anything else, or a pixel off the image.
std::vector<std::uint32_t> sample_pixels(const std::vector<std::uint32_t>& pixels, const std::string& choice,
                                         std::uint32_t width, std::uint32_t height);

}  // namespace penumbra::app
