// SPDX-License-Identifier: Apache-2.0
// Exact areas (in integers), for view samples at which double precision is not enough to be certain of the visible
// share. They are prepared on first use.

#include "volumes/scatter/vectors/areas_on_demand.hpp"

#include "base/assert.hpp"

#include <tbb/task_arena.h>

namespace penumbra::volumes {

void AreasOnDemand::prepare_mesh(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree) {
  scene_ = &scene;
  tree_ = &tree;
  area_.reset();
  is_ready_ = false;
}

void AreasOnDemand::prepare_light(const visibility::Light& light) {
  light_ = &light;
  is_ready_ = false;
}

areas::ExactView AreasOnDemand::view(const visibility::ViewSamples& samples, std::size_t pixel) {
  PENUMBRA_ASSERT(scene_ != nullptr && light_ != nullptr, "prepare_mesh and prepare_light come first: pixel {}", pixel);
  if (!is_ready_) {
    const std::lock_guard lock(mutex_);
    if (!is_ready_) {
      // Runs on all cores, but the waiting thread must not run another view sample's task: that could enter this
      // function again, or overwrite this view sample's buffers.
      tbb::this_task_arena::isolate([&] {
        if (!area_) area_.emplace(*scene_, *tree_);
      });
      area_->set_light(*light_);
      is_ready_ = true;
    }
  }
  return area_->view(
      {samples.p[pixel], static_cast<std::uint32_t>(samples.triangle[pixel]), samples.facing[pixel], samples.n[pixel]});
}

}  // namespace penumbra::volumes
