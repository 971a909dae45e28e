// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <filesystem>

namespace penumbra::mesh {

/// Writes a soup as .stl (binary: single precision, each triangle with its own corners) or .off (text, without loss of
/// precision). The file appears whole or not at all (base/atomic_file.hpp: ResourceError).
void write_stl(const std::filesystem::path& path, const TriangleSoup& soup);
void write_off(const std::filesystem::path& path, const TriangleSoup& soup);

}  // namespace penumbra::mesh
