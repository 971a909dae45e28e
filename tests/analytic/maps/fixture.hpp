#pragma once

// How tests make a method of maps/ and run it.

#include "maps/backprojection/patches/backproject.hpp"
#include "maps/backprojection/patches/backproject_peel.hpp"
#include "maps/backprojection/patches/bitmask.hpp"
#include "maps/backprojection/contours/contour.hpp"
#include "maps/backprojection/contours/packet.hpp"
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.hpp"
#include "maps/sampling/accumulate.hpp"
#include "maps/sampling/adaptive_light.hpp"
#include "maps/sampling/deep_penumbra.hpp"
#include "maps/sampling/layered_attenuation.hpp"
#include "maps/filters/pcss.hpp"
#include "maps/filters/shadow_map.hpp"
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

/// Root of the mean square of difference(pixel) over pixels for which `counts(pixel)`.
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
