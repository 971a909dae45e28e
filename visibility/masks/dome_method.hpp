#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::visibility {

/// The method, which does rectangles infinitely far away (LightPlace::directions), made to do domes: one face of a cube
/// after the other (dome_faces.hpp). Masks of the faces are put side by side into the dome's; of areas the form factors
/// are added up, and V is their sum over dome_form_factor(). Other lights go through unchanged.
std::unique_ptr<Method> with_domes(std::unique_ptr<Method> method);

}  // namespace penumbra::visibility
