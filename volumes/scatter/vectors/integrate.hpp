// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/edges/vectors/edge_scratch.hpp"
#include "volumes/edges/vectors/group.hpp"
#include "volumes/scatter/vectors/areas_on_demand.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace penumbra::areas {
class TextureBlocks;
}

/// Edge scatter on a processor, rows=exact. Inside volumes/ only.
namespace penumbra::volumes {

/// Results: `shares`, the visible fractions of the light (RowSum), without light samples. A fraction that double cannot
/// prove is computed in integers (areas::ExactArea). `radiance`, if not empty: form factors of the visible region,
/// where that is a part of the light.
struct Integral {
  std::span<float> shares;
  std::span<glm::dvec3> radiance;
};
struct LightRegion;
struct IntegralInput {
  const ClusterInput& cluster;
  const LightRegion& region;
  const std::optional<areas::TextureBlocks>& texture;
  const visibility::SceneFloats& scene;
  const visibility::Light& light;
  const visibility::ViewSamples& samples;
  AreasOnDemand& areas;
  float scale;  ///< visibility::device_scale
};
/// Returns the number of view samples whose fraction double could not prove.
std::size_t integrate(const IntegralInput& input, EdgeScratch& scratch, OpenJudge& judge, const Integral& out);

}  // namespace penumbra::volumes
