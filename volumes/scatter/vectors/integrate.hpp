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

/// Not light samples but the light: `shares` of it that are visible (RowSum). A view sample whose share double cannot
/// prove gets it from integers (areas::ExactArea). `radiance`, if there: form factors of what is visible, where that is
/// a part of the light.
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
/// Returns of how many view samples double could not prove the share.
std::size_t integrate(const IntegralInput& input, EdgeScratch& scratch, OpenJudge& judge, const Integral& out);

}  // namespace penumbra::volumes
