#pragma once

#include <cstddef>
#include <cstdint>

namespace penumbra::app {

/// About fifteen pictures a second: milliseconds of one.
inline constexpr double kPictureTime = 62;

/// How much of a picture is made while something moves.
struct LiveQuality {
  std::uint32_t divisor = 2;         ///< of width and height
  std::uint32_t light_samples = 16;  ///< at most, of methods that have them
};

/// Chooses the best quality that keeps about fifteen pictures a second.
class LivePace {
 public:
  [[nodiscard]] LiveQuality quality() const;
  /// Notes what a picture of that quality took.
  void took(double milliseconds);

 private:
  std::size_t level_ = 2;
  static constexpr int kPatience = 4;
  int patience_ = kPatience;  // quick pictures before a better level is tried
  int quick_ = 0;             // since the last change of level
  bool raised_ = false;       // the level is new, and may be too slow
};

}  // namespace penumbra::app
