#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/triangle_tree.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/counters/depth_complexity.shared.h"
#include "volumes/edges/edge_scatter.shared.h"

#include <cstddef>
#include <span>
#include <vector>

namespace penumbra::volumes {

struct DepthJudgeInput {
  const visibility::SceneFloats& scene;
  const visibility::TriangleTree& tree;
  const visibility::ViewSamples& samples;
  const visibility::Light& light;
  std::size_t first_pixel = 0;  ///< of the tile, in the samples
};

/// What exact predicates (visibility/pair_truth.hpp) say, found on all cores.
struct DepthAnswers {
  std::vector<gpu::MaskWord> dark;     ///< whole masks whose reference ray is blocked: to be put in place first
  std::vector<gpu::MaskWord> decided;  ///< the light samples asked about
};
DepthAnswers judge_depths(const DepthJudgeInput& input, std::span<const gpu::DepthQuestion> questions);

/// How many triangles the open segment from a view sample to a light sample meets: the truth behind a counter.
int exact_depth(const DepthJudgeInput& input, std::size_t pixel, std::uint32_t light_sample);

}  // namespace penumbra::volumes
