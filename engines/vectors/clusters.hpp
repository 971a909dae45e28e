#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"
#include "engines/vectors/frame.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// From pixels to clusters of view samples. Inside engines/vectors/ only.
namespace penumbra::native {

/// What is certain of a view sample before any triangle is looked at.
enum class Outlook : std::uint8_t {
  scattered,  ///< the light is, or may be, before it
  all,        ///< not asked: background, or its triangle receives no shadow
  none,       ///< it is behind the light, or the light is below its horizon
  open,       ///< within rounding of the light's plane: exact predicates
  elsewhere,  ///< on the light's other side
};

struct ViewInput {
  const visibility::SceneFloats& scene;
  const visibility::ViewSamples& samples;
  const visibility::LightFrame& light;
  const Frame& frame;
  std::span<const std::uint8_t> normal_is_known;  ///< of each triangle
  float scale;
};
/// Fills `at` if it is scattered or open.
Outlook look(const ViewInput& view, std::uint32_t pixel, Placed& at);

/// Splits view samples where gaps are (an object before a floor), in at most four parts that follow one another; in
/// each they keep their order. Returns where each part ends.
std::vector<std::size_t> split_at_gaps(std::span<Placed> samples);

}  // namespace penumbra::native
