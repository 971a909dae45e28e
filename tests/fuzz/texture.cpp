// Pictures on lights, PNG or OpenEXR: an Error, or a texture that passes its own check.
#include "base/assert.hpp"
#include "base/error.hpp"
#include "scenes/light_texture.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const penumbra::fuzz::Folder folder;
  const auto file = folder.write("texture", {data, size});
  try {
    const penumbra::scenes::Texture texture = penumbra::scenes::read_texture(file, "texture");
    PENUMBRA_ASSERT(texture.texels.size() == std::size_t{texture.width} * texture.height, "{} texels of {}x{}",
                    texture.texels.size(), texture.width, texture.height);
    penumbra::scenes::check_texture(texture, "texture");
  } catch (const penumbra::Error&) {
  }
  return 0;
}
