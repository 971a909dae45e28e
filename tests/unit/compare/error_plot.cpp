// SPDX-License-Identifier: Apache-2.0
// Tests the plot of errors against seconds that `sweep` writes.

#include "compare/error_plot.hpp"

#include <gtest/gtest.h>

#include <string>

namespace penumbra::compare {
namespace {

ErrorPlot plot_of(double rmse) {
  return {{{"first", "", "geometry", 2, 0.0034}, {"second", "", "image", 50, rmse}}};
}

bool has(const ErrorPlot& plot, const char* text) {
  return error_plot_svg(plot, "").find(text) != std::string::npos;
}

/// Labels stay inside the drawing.
TEST(ErrorPlot, NamesFindAPlace) {
  ErrorPlot plot = plot_of(0.0034);
  EXPECT_FALSE(has(plot, "<text text-anchor=\"end\" x="));
  plot.marks[1].name = "bitmask:size=128:occluder=patch:fill=diagonal";
  EXPECT_TRUE(has(plot, "<text text-anchor=\"end\" x="));
}

/// A method whose error is below a float's last digit does not push all others into a corner.
TEST(ErrorPlot, ErrorsBelowAFloatsLastDigitAreNone) {
  EXPECT_TRUE(has(plot_of(2.5e-10), "\">0</text>"));
  EXPECT_FALSE(has(plot_of(2.5e-10), "1e-1"));
  EXPECT_FALSE(has(plot_of(2e-6), "\">0</text>"));
  EXPECT_TRUE(has(plot_of(2e-6), "\">1e-6</text>"));
  EXPECT_FALSE(has(plot_of(2e-6), "0.00000"));
}

}  // namespace
}  // namespace penumbra::compare
