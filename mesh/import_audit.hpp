#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace penumbra::mesh {

/// Compares what a PLY file's header promises, for which Assimp would allocate first, with the bytes that follow it.
/// The number of faces that it promises, with whatever number of corners; nothing if it cannot be told. Throws
/// InputError.
std::optional<std::uint64_t> audit_ply(std::string_view content, const std::string& file);

}  // namespace penumbra::mesh
