// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/session.hpp"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace penumbra::session {

/// Adds the radiance of visible domes (scenes::AreaLight::visible) to their beauty at the background's pixels.
/// `beauty`: of each whole light, all pixels, or empty.
void add_visible_skies(const Session& session, std::span<std::vector<glm::vec3>> beauty);

}  // namespace penumbra::session
