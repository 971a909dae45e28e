#pragma once

#include <string>
#include <string_view>

namespace penumbra::scenes {

/// Refuses numbers in a glTF file's JSON that tinygltf drops silently, and then reads as if they were not there:
/// indices, counts, offsets and sizes that are negative, no integers or no numbers. InputError with the JSON pointer.
/// Also refuses any version but 2. Text that is no JSON passes: that is tinygltf's to say.
void check_gltf_numbers(std::string_view json, const std::string& file);

}  // namespace penumbra::scenes
