// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace penumbra::visibility {

/// Returns the barycentric coordinates of shares_on_line (surface_alpha.hpp) from its three signed volumes, which the
/// direction spans with corners 1 and 2, 2 and 0, and 0 and 1.
glm::dvec3 shares_from(const glm::dvec3& volumes);

}  // namespace penumbra::visibility
