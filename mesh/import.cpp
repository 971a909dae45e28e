// SPDX-License-Identifier: Apache-2.0
// Runs the import helper for a mesh file and checks its answer.

#include "mesh/import.hpp"

#include "base/error.hpp"
#include "mesh/import_helper.hpp"
#include "mesh/import_wire.hpp"

#include <utility>

namespace penumbra::mesh {

ImportedMesh import_mesh(const std::filesystem::path& file, const ImportLimits& limits) {
  return import_mesh(open_input(file), limits);
}

ImportedMesh import_mesh(const InputFile& input, const ImportLimits& limits, GltfMeshOptions gltf, bool with_places) {
  HelperJob job{"mesh", input, {}};
  if (gltf.allow_outside) job.flags.emplace_back("--allow-outside");
  if (gltf.lenient) job.flags.emplace_back("--lenient");
  if (with_places) job.flags.emplace_back("--uv=0");
  HelperAnswer answer = run_import_helper(job, limits);
  try {
    WireReader from(answer.payload());
    ImportedMesh mesh = get_mesh(from);
    mesh.sources = std::move(answer.sources);
    if (with_places) mesh.places = from.get_array<glm::dvec2>();
    if (!mesh.places.empty() && mesh.places.size() != mesh.soup.positions.size())
      throw WireError("the number of texture coordinates is wrong");
    from.expect_end();
    if (mesh.soup.triangles.empty()) throw WireError("it holds no triangles");
    return mesh;
  } catch (const WireError& error) {
    throw InputError("{}: the importer's answer is damaged ({}); the file is probably damaged", input.name.string(),
                     error.what());
  }
}

}  // namespace penumbra::mesh
