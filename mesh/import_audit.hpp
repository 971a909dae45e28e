#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::mesh {

/// What a file says of itself, read before Assimp reads the rest.
struct FileAudit {
  std::optional<std::uint64_t> surfaces;  ///< faces with three corners or more that the file holds or promises
  std::vector<std::string> notes;
  std::optional<std::string> text;  ///< the file's text as Assimp must see it, if that differs from the file
};

/// Looks through OBJ, PLY and STL files for what Assimp passes over in silence or says without a line number: vertex
/// lines that it drops (and so renumbers all that follow), indices out of range, coordinates that are not finite,
/// headers that promise more than the file holds (for which it would allocate first). Throws InputError with the line;
/// other formats pass unseen.
FileAudit audit_mesh_file(const std::filesystem::path& file);

}  // namespace penumbra::mesh
