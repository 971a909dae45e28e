// SPDX-License-Identifier: Apache-2.0
// Fuzzes pictures on lights, PNG or OpenEXR, as the import helper reads them: the result is an Error, or as many texels
// as it declares.
#include "base/assert.hpp"
#include "base/error.hpp"
#include "import/texture_file.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const penumbra::fuzz::Folder folder;
  const auto file = folder.write("texture", {data, size});
  try {
    const penumbra::scenes::Texture texture = penumbra::import::read_texture_file(penumbra::mesh::open_input(file));
    PENUMBRA_ASSERT(texture.texels.size() == std::size_t{texture.width} * texture.height, "{} texels of {}x{}",
                    texture.texels.size(), texture.width, texture.height);
  } catch (const penumbra::Error&) {
  }
  return 0;
}
