#pragma once

#include "app/compare/light_judge.hpp"
#include "app/session.hpp"

#include <span>
#include <vector>

namespace penumbra::app {

/// Sorts each light's judged pixels by what happens there, once V of the reference is known (LightTruth::classes): by
/// that V (lit, penumbra, umbra), and by whose triangles hide some of the light (cast: another object's, self: those of
/// the object that the pixel shows; a pixel can be in both); and says how wide penumbrae are there, and how far what
/// hides the light is (LightTruth::sizes). Throws InputError for a light that rays do not reach, and
/// ResourceError; then the classes by V are there all the same.
void sort_into_classes(const Session& session, std::vector<LightTruth>& truths, Progress& progress);

}  // namespace penumbra::app
