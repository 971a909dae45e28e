// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/comparison/light_judge.hpp"
#include "session/session.hpp"

#include <span>
#include <vector>

namespace penumbra::session {

/// Classifies each light's judged pixels, once V of the reference is known (LightTruth::classes): by V (lit, penumbra,
/// umbra), and by the object whose triangles hide some of the light (cast: another object's, self: those of the object
/// visible at the pixel; a pixel can be in both); and computes the width of penumbrae and the distance of the hiding
/// object (LightTruth::sizes). Throws InputError for a light not supported by rays, and ResourceError; the classes by V
/// are set in both cases.
void sort_into_classes(const Session& session, std::vector<LightTruth>& truths, Progress& progress);

}  // namespace penumbra::session
