#pragma once

#include "maps/screen/screen_picture.hpp"
#include "visibility/method.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace penumbra::maps {

/// How far around a view sample a method looks, as a share of the scene's diagonal.
inline constexpr visibility::RealOption kRadius{
    "radius", 0.001, 16, 0.05, "how far around a view sample the picture is asked, in diagonals of the scene's box"};
inline constexpr auto kDither = visibility::flag_option(
    "dither", true,
    "turn what is asked by another angle at each of 4 x 4 pixels, and take means over as many; off: neither");

/// The dither's pattern: pixels 4 apart have the same number.
inline constexpr std::uint32_t kDitherWidth = 4, kDithers = kDitherWidth * kDitherWidth;

/// V of a pixel of the picture that shows a surface. `radius` is in scene floats, `dither` below kDithers, 0 where
/// there is none.
using ScreenVisibility =
    std::function<double(const ScreenPicture& picture, std::size_t pixel, double radius, std::uint32_t dither)>;

/// The description that methods of this kind share; what each is exact for, its own options and verdict are added.
visibility::MethodDescription screen_description(const std::string& name, const std::string& paper);

/// A method that asks the camera's picture. Its description has the options above.
std::unique_ptr<visibility::Method> make_screen_method(visibility::MethodDescription description,
                                                       const visibility::ParsedOptions& options,
                                                       ScreenVisibility visibility);

}  // namespace penumbra::maps
