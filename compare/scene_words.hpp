// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <string>

namespace penumbra::compare {

/// Returns "a rectangle of 2 × 1 at (0, 4, 0), radiance (10, 10, 10), from both sides".
std::string words_of(const scenes::AreaLight& light);

/// Returns "at (2, 3, 6), looking at (0, 0.5, 0), 45° high".
std::string words_of(const scenes::Camera& camera);

}  // namespace penumbra::compare
