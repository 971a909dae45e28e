// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/image.hpp"
#include "mesh/triangle_soup.hpp"
#include "session/inspect/examine.hpp"

#include <cstdint>

namespace penumbra::app {

/// Returns a picture of the mesh with its defects in the colours of --export-defects, twice: seen from its front, right
/// and above, and from the opposite side. Edges and vertices with a defect are drawn over the surface, paler where the
/// surface hides them. The picture is 2 `side` wide and `side` high. `report` must list all locations of the soup's
/// defects. Throws InputError for coordinates out of a scene's range.
Image8 defect_picture(const mesh::TriangleSoup& soup, const session::ObjectReport& report, std::uint32_t side);

}  // namespace penumbra::app
