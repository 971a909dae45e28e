// SPDX-License-Identifier: Apache-2.0
// View samples by the GPU's visibility buffer, by scan conversion, or by a tree of boxes.

#include "engines/view_sampler.hpp"

#include "engines/engine_choice.hpp"
#include "engines/vectors/scan_conversion.hpp"
#include "visibility/tree/view_walk.hpp"

namespace penumbra::engines {

ViewSampler::ViewSampler(const render::Machine& machine, const visibility::SceneFloats& scene) : scene_(scene) {
  if (runs_on_vectors(machine, Engine::automatic)) return;
  if (render::VisibilityBuffer::runs_on(machine.device().info())) buffer_.emplace(machine.device(), scene);
}

visibility::ViewSamples ViewSampler::find(const visibility::PinholeCamera& camera) {
  if (camera.half_height || camera.lens) return visibility::walk_view_samples(scene_, camera);
  return look_through(scene_, camera, buffer_ ? buffer_->render(camera) : vectors::scan_view_samples(scene_, camera));
}

}  // namespace penumbra::engines
