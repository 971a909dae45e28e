// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace penumbra::session {

/// Estimate of a run's time before its end. A tile takes a fixed time, such as that of drawing all maps again, and a
/// time for each of its rows. Both are found by least squares over the completed tiles, which have different numbers of
/// rows.
class RunEstimate {
 public:
  /// `lights`, `rows`: numbers of the whole run's lights, and of each light's rows.
  RunEstimate(std::size_t lights, std::uint32_t rows) : lights_(static_cast<double>(lights)), rows_(rows) {}

  void add(std::uint32_t rows, double seconds) {
    const double size = rows;
    ++count_, sizes_ += size, squares_ += size * size, seconds_ += seconds, products_ += size * seconds;
  }
  [[nodiscard]] bool is_done() const { return sizes_ == lights_ * rows_; }
  /// Returns the seconds of a tile of that many rows.
  [[nodiscard]] double of_tile(double rows) const { return of_each_tile() + rows * of_each_row(); }
  /// Returns the seconds of a whole run in tiles of that many rows. `elapsed`: seconds so far; `mesh`: those of them
  /// spent on meshes. All other time outside of tiles is spent once for each light.
  [[nodiscard]] double of_all(double elapsed, double mesh, std::uint32_t rows_of_tile) const {
    const double begun = std::ceil(sizes_ / rows_);
    return mesh + (elapsed - mesh - seconds_) * lights_ / begun +
           lights_ * (tiles_of_light(rows_of_tile) * of_each_tile() + rows_ * of_each_row());
  }
  /// Returns the seconds spent on tiles beyond the number that tiles of that many rows would have needed.
  [[nodiscard]] double of_bands(std::uint32_t rows_of_tile) const {
    return std::max(count_ - lights_ * tiles_of_light(rows_of_tile), 0.0) * of_each_tile();
  }

 private:
  [[nodiscard]] double tiles_of_light(std::uint32_t rows_of_tile) const { return std::ceil(rows_ / rows_of_tile); }
  [[nodiscard]] double of_each_tile() const {
    const double spread = count_ * squares_ - sizes_ * sizes_;
    if (!(spread > 0)) return 0;  // all tiles have the same number of rows
    return std::clamp((seconds_ * squares_ - sizes_ * products_) / spread, 0.0, seconds_ / count_);
  }
  [[nodiscard]] double of_each_row() const { return (seconds_ - count_ * of_each_tile()) / sizes_; }

  double lights_, rows_;  // of the whole run; rows of each light
  double count_ = 0, sizes_ = 0, squares_ = 0, seconds_ = 0, products_ = 0;
};

}  // namespace penumbra::session
