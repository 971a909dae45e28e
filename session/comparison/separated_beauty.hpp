// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/comparison/light_judge.hpp"
#include "session/session.hpp"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace penumbra::session {

/// Returns the linear beauty computed from V of the reference alone, V · ∫G, light by light (compare::Separation).
/// Empty if a light is divided into pieces, since V of each piece is unknown.
std::vector<glm::vec3> separated_beauty(const Session& session, std::span<const LightTruth> truths);

}  // namespace penumbra::session
