// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::visibility {

/// Extends a method that supports rectangles infinitely far away (LightPlace::directions) to domes: one face of a cube
/// after the other (dome_faces.hpp). Masks of the faces are combined into the dome's; for areas the form factors are
/// added up, and V is their sum over dome_form_factor(). Other lights are passed on unchanged.
std::unique_ptr<Method> with_domes(std::unique_ptr<Method> method);

}  // namespace penumbra::visibility
