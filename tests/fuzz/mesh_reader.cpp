// SPDX-License-Identifier: Apache-2.0
// Fuzzes the readers of the import helper: the first byte chooses the format, the rest is the file's content. Our own
// code reads all of these formats, but of COLLADA only the part before Assimp.
#include "base/error.hpp"
#include "import/audit_collada.hpp"
#include "import/read.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/folder.hpp"
#include "tests/fuzz/imported.hpp"

#include <array>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const penumbra::fuzz::Folder folder;
  constexpr std::array kFormats = {".obj", ".ply", ".stl", ".off", ".amf", ".3mf", ".x3d", ".dae"};
  if (size < 2) return 0;
  const std::size_t format = data[0] % kFormats.size();
  if (format + 1 == kFormats.size()) {
    const std::string_view content(reinterpret_cast<const char*>(data) + 1, size - 1);
    try {
      penumbra::import::triangles_of_collada(content, "mesh.dae");
      penumbra::import::without_leading_blanks(content, "mesh.dae");
    } catch (const penumbra::InputError&) {
    } catch (const std::bad_alloc&) {
    }
    return 0;
  }
  const auto file = folder.write(std::string("mesh") + kFormats[format], {data + 1, size - 1});
  try {
    penumbra::fuzz::check_imported(penumbra::import::read_mesh(penumbra::mesh::open_input(file)));
  } catch (const penumbra::InputError&) {
  } catch (const std::bad_alloc&) {  // the helper answers to these exceptions, too
  } catch (const std::length_error&) {
  }
  return 0;
}
