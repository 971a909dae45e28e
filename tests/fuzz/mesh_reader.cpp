// What runs inside the import helper, on any file: the first byte chooses the format, the rest is the file's content.
// All of these are read by our own code.
#include "base/error.hpp"
#include "import/read.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/folder.hpp"
#include "tests/fuzz/imported.hpp"

#include <array>
#include <new>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const penumbra::fuzz::Folder folder;
  constexpr std::array kFormats = {".obj", ".ply", ".stl", ".off", ".amf", ".3mf"};
  if (size < 2) return 0;
  const auto file = folder.write(std::string("mesh") + kFormats[data[0] % kFormats.size()], {data + 1, size - 1});
  try {
    penumbra::fuzz::check_imported(penumbra::mesh::read_mesh(penumbra::mesh::open_input(file)));
  } catch (const penumbra::InputError&) {
  } catch (const std::bad_alloc&) {  // the helper answers with these, too
  } catch (const std::length_error&) {
  }
  return 0;
}
