#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::compare {

/// RMSE of V against seconds for the shadow, both axes logarithmic; what has no error at all stands on a line of its
/// own.
struct ErrorPlot {
  struct Mark {
    std::string name;    ///< written beside the mark; empty: nothing is
    std::string title;   ///< what is said of it when it is pointed at
    std::string family;  ///< geometry, image or reference: its shape and colour
    double seconds = 0, rmse = 0;
  };
  /// An error that no method of some kind can go below, with what is written there.
  struct Level {
    double rmse = 0;
    std::string text;
  };
  std::vector<Mark> marks;                           ///< with seconds > 0
  std::vector<std::vector<std::size_t>> lines = {};  ///< through marks (indices), in order
  std::optional<Level> level = {};
  std::string across = "seconds for the shadow";  ///< below the axis
};

/// An error of V, which is a float, of less than half of its last digit is drawn as none.
inline constexpr double kNoError = 0x1p-25;

/// An element `svg` of class `plot`, whose parts have the classes of page/viewer.css. `attributes`: further ones.
std::string error_plot_svg(const ErrorPlot& plot, const std::string& attributes);

}  // namespace penumbra::compare
