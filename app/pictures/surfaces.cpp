#include "app/pictures/surfaces.hpp"

#include <algorithm>
#include <cstddef>

namespace penumbra::app {

Surfaces surfaces_of(const Session& session) {
  Surfaces all;
  std::vector<std::uint32_t> material_of;
  for (const scenes::Object& object : session.scene.objects) {
    all.objects.push_back(object.name);
    material_of.push_back(Surfaces::kNothing);
    if (object.material.empty()) continue;
    const auto known = std::ranges::find(all.materials, object.material);
    material_of.back() = static_cast<std::uint32_t>(known - all.materials.begin());
    if (known == all.materials.end()) all.materials.push_back(object.material);
  }
  for (const std::int32_t triangle : session.samples.triangle) {
    const bool background = triangle == visibility::ViewSamples::kBackground;
    all.object.push_back(background ? Surfaces::kNothing : session.floats.object[static_cast<std::size_t>(triangle)]);
    all.material.push_back(background ? Surfaces::kNothing : material_of[all.object.back()]);
  }
  return all;
}

}  // namespace penumbra::app
