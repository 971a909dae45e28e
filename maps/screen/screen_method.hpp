// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/screen/screen_picture.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace penumbra::maps {

/// Radius of a method's search around a view sample, as a fraction of the scene's diagonal.
inline constexpr visibility::RealOption kRadius{
    "radius", 0.001, 16, 0.05, "radius of the search around a view sample, in diagonals of the scene's box"};
inline constexpr auto kDither = visibility::flag_option("dither", true,
                                                        "on: rotates the search by another angle at each of 4 x 4 "
                                                        "pixels, and averages V over as many pixels; off: neither");

/// Pattern of the dither: pixels 4 apart have the same number.
inline constexpr std::uint32_t kDitherWidth = 4, kDithers = kDitherWidth * kDitherWidth;

/// Function that returns V of a pixel that shows a surface. `radius` is in scene floats, `dither` below kDithers, 0
/// without dithering.
using ScreenVisibility =
    std::function<double(const ScreenPicture& picture, std::size_t pixel, double radius, std::uint32_t dither)>;

/// Returns the common description of methods of this kind; the caller adds the exact cases, its own options and
/// verdict.
visibility::MethodDescription screen_description(const std::string& name, const std::string& paper);

/// Makes a method that uses the camera's picture. Its description must have the options above.
std::unique_ptr<visibility::Method> make_screen_method(visibility::MethodDescription description,
                                                       const visibility::ParsedOptions& options,
                                                       ScreenVisibility visibility);

}  // namespace penumbra::maps
