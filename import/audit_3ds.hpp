// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace penumbra::import {

/// Throws InputError for a 3D Studio file with a chunk that exceeds its parent, or that claims more vertices, faces or
/// keys than it has room for: Assimp would allocate memory for them before checking.
void audit_3ds(std::string_view content, const std::string& file);

}  // namespace penumbra::import
