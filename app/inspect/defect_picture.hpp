#pragma once

#include "app/inspect/examine.hpp"
#include "base/image.hpp"
#include "mesh/triangle_soup.hpp"

#include <cstdint>

namespace penumbra::app {

/// The mesh with its defects in the colours of --export-defects, twice: seen from its front, right and above, and from
/// the opposite side. Edges and vertices with a defect are drawn over the surface, paler where it hides them. The
/// picture is 2 `side` wide and `side` high. `report` lists all places of the soup's defects. Throws InputError for
/// coordinates that no scene can hold.
Image8 defect_picture(const mesh::TriangleSoup& soup, const ObjectReport& report, std::uint32_t side);

}  // namespace penumbra::app
