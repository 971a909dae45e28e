#pragma once

#include "app/inspect/examine.hpp"

#include <filesystem>
#include <string>

namespace penumbra::app {

/// Writes all triangles with the bad ones coloured, and bad edges as coloured edges. `report` must list every place.
/// What several defects claim has the colour of the one that comes last in the legend.
void export_defects(const std::filesystem::path& file, const mesh::TriangleSoup& soup, const ObjectReport& report);

/// The colours, one defect a line.
std::string defect_legend();

}  // namespace penumbra::app
