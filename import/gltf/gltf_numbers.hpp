// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace penumbra::import {

/// Refuses numbers in a glTF file's JSON that tinygltf silently ignores or takes modulo 2³²: indices, counts, offsets
/// and sizes that are negative, too large, not integers or not numbers. Throws InputError with the JSON pointer. Also
/// refuses any version but 2.
void check_gltf_numbers(const nlohmann::json& document, const std::string& file);

}  // namespace penumbra::import
