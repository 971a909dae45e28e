// SPDX-License-Identifier: Apache-2.0
#pragma once
// Support for tests of the predicates of docs/predicates.md.

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/backprojection/contour_scenes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace penumbra::tests {

class MapsPredicates : public MapsTest {
 protected:
  static Masks exact(const Stage& stage) { return tests::run(*reference::make_exact({}), stage); }
  static Masks soft(const Stage& stage, const visibility::MethodOptions& options) {
    return run(maps::make_soft_shadow_map, stage, options);
  }
  static void record(const std::string& what, double value) {
    RecordProperty(what, fmt::format("{:.5g}", value));
    fmt::print("{}: {:.5g}\n", what, value);
  }
  /// Atty's measure (2006, section 5.2.1).
  static double shadow_error(const Masks& found, const Masks& truth) {
    double sum = 0, shaded = 0;
    for (std::size_t i = 0; i < found.visibility.size(); ++i) {
      if (truth.visibility[i] >= 1) continue;
      sum += static_cast<double>(std::abs(found.visibility[i] - truth.visibility[i]));
      shaded += 1;
    }
    EXPECT_GT(shaded, 50);
    return sum / shaded;
  }
  static double bias(const Masks& found, const Masks& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < found.visibility.size(); ++i) {
      sum += static_cast<double>(found.visibility[i]) - static_cast<double>(truth.visibility[i]);
    }
    return sum / static_cast<double>(found.visibility.size());
  }
};

}  // namespace penumbra::tests
