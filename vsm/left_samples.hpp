// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/pairs/light_box.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::vsm {

/// Left-sample maps (Eisemann and Décoret 2007, section 4.3): the lines of the light's plane, arranged by angle and
/// distance. Each texel stores the light samples to the left of its line.
///
/// Departure: in addition to those of its middle line, a texel stores the light samples to the left of all of its
/// lines, and of any of them. Light samples between these two sets are not determined by the map.
class LeftSamples {
 public:
  /// The line a A + b B + C = 0 in the light's axes; left is where the expression is positive. `error` is the largest
  /// error of its value.
  struct Line {
    double a = 0, b = 0, c = 0, error = 0;
  };
  struct Texel {
    std::span<const std::uint32_t> all, any, middle;  ///< words_per_mask() words each
  };

  LeftSamples() = default;
  LeftSamples(const visibility::Light& light, const pairs::LightBox& box, std::uint32_t angles,
              std::uint32_t distances);

  [[nodiscard]] Texel at(const Line& line) const;
  [[nodiscard]] std::uint64_t bytes() const {
    return (all_.capacity() + any_.capacity() + middle_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  [[nodiscard]] Texel texel(std::size_t number) const;

  glm::dvec2 center_{0};
  double radius_ = 0;  // radius of a disk around all light samples
  std::uint32_t angles_ = 0, distances_ = 0;
  std::size_t words_ = 0;
  std::vector<std::uint32_t> all_, any_, middle_;  // a row of distances for each angle; then three texels: all, none,
                                                   // unknown
};

}  // namespace penumbra::vsm
