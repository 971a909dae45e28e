#pragma once

#include "app/session.hpp"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace penumbra::app {

/// Adds to the beauty of domes that are visible (scenes::AreaLight::visible) what the background's pixels see of them.
/// `beauty`: of each whole light, all pixels, or empty.
void add_visible_skies(const Session& session, std::span<std::vector<glm::vec3>> beauty);

}  // namespace penumbra::app
