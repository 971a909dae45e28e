// SPDX-License-Identifier: Apache-2.0
// Fuzzes 3D Studio files as the import helper reads them: first by Assimp, which is the system's and not instrumented,
// then by our code. Whatever Assimp makes of a damaged file, an accepted mesh keeps its promises.
#include "base/error.hpp"
#include "import/read.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/folder.hpp"
#include "tests/fuzz/imported.hpp"

#include <new>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const penumbra::fuzz::Folder folder;
  if (size == 0) return 0;
  const auto file = folder.write("mesh.3ds", {data, size});
  try {
    penumbra::fuzz::check_imported(penumbra::import::read_mesh(penumbra::mesh::open_input(file)));
  } catch (const penumbra::InputError&) {
  } catch (const std::bad_alloc&) {  // the helper answers to these exceptions, too
  } catch (const std::length_error&) {
  }
  return 0;
}
