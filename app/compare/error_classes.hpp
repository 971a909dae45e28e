#pragma once

#include "app/compare/light_judge.hpp"
#include "app/session.hpp"

#include <span>
#include <vector>

namespace penumbra::app {

/// Sorts each light's judged pixels by what happens there, once V of the reference is known (LightTruth::classes): by
/// that V (lit, penumbra, umbra), and by whose triangles hide some of the light (cast: another object's, self: those of
/// the object that the pixel shows; a pixel can be in both).
void sort_into_classes(const Session& session, std::vector<LightTruth>& truths);

}  // namespace penumbra::app
