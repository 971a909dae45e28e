// SPDX-License-Identifier: Apache-2.0
#pragma once

// Makes and runs a method of maps/ in a test.

#include "maps/backprojection/patches/methods.hpp"
#include "maps/backprojection/contours/methods.hpp"
#include "maps/backprojection/soft_shadow_map/methods.hpp"
#include "maps/sampling/methods.hpp"
#include "maps/single_shadow/methods.hpp"
#include "maps/filters/methods.hpp"
#include "tests/agreement/support.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <string>

namespace penumbra::tests {

using Factory =
    std::function<std::unique_ptr<visibility::Method>(const render::Device&, const visibility::MethodOptions&)>;

class MapsTest : public DeviceTest {
 protected:
  static Masks run(visibility::Method& method, const Stage& stage, std::uint32_t rows_at_once = 0) {
    return tests::run(method, stage, rows_at_once);
  }
  static Masks run(const Factory& factory, const Stage& stage, const visibility::MethodOptions& options = {}) {
    return tests::run(*factory(device(), options), stage);
  }
};

/// Root mean square of difference(pixel) over pixels for which `counts(pixel)`.
inline double rmse(const Stage& stage, const std::function<bool(std::size_t)>& counts,
                   const std::function<double(std::size_t)>& difference) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!counts(i)) continue;
    sum += difference(i) * difference(i);
    ++count;
  }
  EXPECT_GT(count, 0u);
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace penumbra::tests
