// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

namespace penumbra::app {

/// Largest time of one picture during changes, in milliseconds. A move that comes just after a picture began is shown
/// after two pictures, and must be seen within 120 ms.
inline constexpr double kPictureTime = 45;
/// Milliseconds; a picture faster than this leaves time for better quality. A final picture that is as fast is rendered
/// at once, without a quick one first.
inline constexpr double kQuickTime = 20;

/// Quality of a picture during changes.
struct LiveQuality {
  std::uint32_t divisor = 2;         ///< of width and height
  std::uint32_t light_samples = 16;  ///< at most, for methods with light samples
};

/// Methods that are too slow for pictures during changes, even at the lowest quality.
class SlowMethods {
 public:
  /// Records the duration of a method's part of a picture; a method is slow after two slow pictures in a row, since the
  /// first may include its preparation. `lowest`: the picture has the lowest quality.
  void took(const std::string& entry, double milliseconds, bool lowest);
  /// Records the duration of a method's part of a final picture: a method that is fast there is not slow.
  void took_final(const std::string& entry, double milliseconds);
  [[nodiscard]] bool contains(const std::string& entry) const { return entries_.contains(entry); }
  void clear();

 private:
  std::set<std::string> entries_, once_;  // once_: the last picture was slow
};

/// Chooses the best quality whose pictures take at most kPictureTime, about twenty a second.
class LivePace {
 public:
  [[nodiscard]] LiveQuality quality() const;
  [[nodiscard]] bool is_lowest() const;
  /// Records the duration of a picture with the current quality.
  void took(double milliseconds);

 private:
  std::size_t level_ = 2;
  static constexpr int kPatience = 4;
  int patience_ = kPatience;  // number of quick pictures before a better level is tried
  int quick_ = 0;             // number since the last change of level
  bool raised_ = false;       // the level is new, and may be too slow
};

}  // namespace penumbra::app
