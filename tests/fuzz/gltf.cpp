// SPDX-License-Identifier: Apache-2.0
// Fuzzes the glTF reader with any file, as a scene and as a mesh: the result is an InputError, or a scene that passes
// the checks of the importer's answer, with the same triangles both times.
#include "base/assert.hpp"
#include "base/error.hpp"
#include "mesh/import_wire.hpp"
#include "import/gltf/gltf_import.hpp"
#include "scenes/scene_wire.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/folder.hpp"
#include "tests/fuzz/imported.hpp"

#include <new>
#include <optional>
#include <stdexcept>

namespace {

using namespace penumbra;

/// Returns the result, or nullopt if the file is refused.
template <typename Read>
auto attempt(Read read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const InputError&) {
  } catch (const std::bad_alloc&) {  // the helper answers to these exceptions, too
  } catch (const std::length_error&) {
  }
  return std::nullopt;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  if (size == 0) return 0;
  const mesh::InputFile input = mesh::open_input(folder.write("scene.glb", {data, size}));
  const auto scene = attempt([&] {
    scenes::Scene read;
    penumbra::import::import_gltf_scenes(input, {.needs_light = false}, {},
                                         [&](scenes::Scene one, const scenes::Instances& /*none*/) {
                                           read = std::move(one);
                                           return false;
                                         });
    return read;
  });
  if (scene) {
    mesh::WireWriter writer;
    scenes::put_scene(writer, *scene);
    const std::vector<std::byte> bytes = writer.bytes();
    mesh::WireReader reader(bytes);
    const scenes::Scene again = scenes::get_scene(reader);  // throws if a promise of the reader is broken
    PENUMBRA_ASSERT(again.soup.triangles == scene->soup.triangles, "{} triangles became {}",
                    scene->soup.triangles.size(), again.soup.triangles.size());
  }
  const auto mesh = attempt([&] { return penumbra::import::import_gltf_mesh(input, {.lenient = true}); });
  if (mesh) fuzz::check_imported(*mesh);
  // A scene may be refused only for its cameras and lights; but a file that can be read as a scene can be read as a
  // mesh.
  PENUMBRA_ASSERT(mesh || !scene, "read as a scene, but not as a mesh");
  if (scene && mesh) {
    PENUMBRA_ASSERT(mesh->soup.triangles == scene->soup.triangles, "{} triangles as a mesh, {} as a scene",
                    mesh->soup.triangles.size(), scene->soup.triangles.size());
  }
  return 0;
}
