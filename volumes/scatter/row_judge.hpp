#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/triangle_tree.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/edges/edge_scatter.shared.h"

#include <cstddef>
#include <span>
#include <vector>

namespace penumbra::volumes {

struct RowJudgeInput {
  const visibility::SceneFloats& scene;
  const visibility::TriangleTree& tree;
  const visibility::ViewSamples& samples;
  const visibility::Light& light;  ///< its samples in rows
  std::size_t first_pixel = 0;     ///< of the tile, in the samples
};

/// Decides every light sample asked about, those of whole rows and single ones, by exact predicates
/// (visibility/pair_truth.hpp), on all cores. Words in the layout of scatter_edges.comp: 8 columns × 4 rows each.
std::vector<gpu::MaskWord> judge_rows(const RowJudgeInput& input, std::span<const gpu::RowQuestion> questions);

}  // namespace penumbra::volumes
