// SPDX-License-Identifier: Apache-2.0
// Maps view samples to objects and materials.

#include "session/pictures/surfaces.hpp"

#include <algorithm>

namespace penumbra::session {

Surfaces::Surfaces(const Session& session) : session_(&session) {
  for (const scenes::Object& object : session.scene.objects) {
    objects_.push_back(object.name);
    material_of_.push_back(kNothing);
    if (object.material.empty()) continue;
    const auto known = std::ranges::find(materials_, object.material);
    material_of_.back() = static_cast<std::uint32_t>(known - materials_.begin());
    if (known == materials_.end()) materials_.push_back(object.material);
  }
}

std::uint32_t Surfaces::object(std::size_t view_sample) const {
  const std::int32_t triangle = session_->samples.triangle[view_sample];
  if (triangle == visibility::ViewSamples::kBackground) return kNothing;
  return session_->floats.object[static_cast<std::size_t>(triangle)];
}

std::uint32_t Surfaces::material(std::size_t view_sample) const {
  const std::uint32_t object = this->object(view_sample);
  return object == kNothing ? kNothing : material_of_[object];
}

}  // namespace penumbra::session
