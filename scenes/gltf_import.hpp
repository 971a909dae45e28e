#pragma once

#include "scenes/reader.hpp"
#include "scenes/scene.hpp"

#include <filesystem>

namespace penumbra::scenes {

/// Reads a glTF scene in this very process: what the import helper does under its limits; everybody else calls
/// read_gltf. Throws InputError; std::bad_alloc.
Scene import_gltf(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace penumbra::scenes
