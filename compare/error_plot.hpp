// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::compare {

/// Plot of RMSE of V against seconds for the shadow, both axes logarithmic; marks without any error are on a
/// separate line.
struct ErrorPlot {
  struct Mark {
    std::string name;    ///< written next to the mark; empty: no text
    std::string title;   ///< tooltip of the mark
    std::string family;  ///< geometry, image or reference: determines shape and colour
    double seconds = 0, rmse = 0;
  };
  /// Smallest error that methods of some kind can have, with its label.
  struct Level {
    double rmse = 0;
    std::string text;
  };
  std::vector<Mark> marks;                           ///< with seconds > 0
  std::vector<std::vector<std::size_t>> lines = {};  ///< through marks (indices), in order
  std::optional<Level> level = {};
  std::string across = "seconds for the shadow";  ///< label of the axis
};

/// Errors of V below half of the last digit of a float are drawn as 0.
inline constexpr double kNoError = 0x1p-25;

/// Returns an element `svg` of class `plot`, whose parts have the classes of page/viewer.css. `attributes`: further
/// attributes.
std::string error_plot_svg(const ErrorPlot& plot, const std::string& attributes);

}  // namespace penumbra::compare
