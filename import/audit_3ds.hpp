#pragma once

#include <string>
#include <string_view>

namespace penumbra::mesh {

/// Throws InputError for a 3D Studio file with a chunk that reaches beyond the one that it is part of, or that says it
/// holds more vertices, faces or keys than there is room for: Assimp would allocate first and look later.
void audit_3ds(std::string_view content, const std::string& file);

}  // namespace penumbra::mesh
