#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/native_scatter.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// From pixels to clusters of view samples. Inside volumes/ only.
namespace penumbra::volumes::native {

/// What is certain of a view sample before any triangle is looked at.
enum class Outlook : std::uint8_t {
  scattered,  ///< the light is, or may be, before it: a Sample
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
struct Looked {
  Outlook outlook = Outlook::all;
  Sample sample;  ///< but for what depends on its cluster
};
Looked look(const ViewInput& view, std::uint32_t pixel);

/// Splits them where gaps are (an object before a floor), in at most four; each keeps their order.
std::vector<Cluster> make_clusters(const Frame& frame, std::vector<Sample> samples);

}  // namespace penumbra::volumes::native
