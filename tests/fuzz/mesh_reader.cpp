// What runs inside the import helper, on any file: the first byte chooses the format, the rest is the file's content.
// Assimp is the system's and not instrumented; around it, our audits of OBJ, PLY and STL files, the OFF reader, and the
// faces' way into the soup are.
#include "base/error.hpp"
#include "mesh/import_read.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/imported.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>

#include <unistd.h>

namespace {

constexpr std::array kFormats = {".obj", ".ply", ".stl", ".off"};

/// A folder of its own, so that what a file names beside itself is not there.
class Folder {
 public:
  Folder() : path_((std::filesystem::temp_directory_path() / "penumbra-fuzz-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) std::abort();
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::filesystem::path path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  if (size == 0) return 0;
  const auto file = folder.path() / (std::string("mesh") + kFormats[data[0] % kFormats.size()]);
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data + 1), static_cast<long>(size) - 1);
  try {
    penumbra::fuzz::check_imported(penumbra::mesh::read_mesh_file(file));
  } catch (const penumbra::InputError&) {
  } catch (const std::bad_alloc&) {  // the helper answers with it, too
  }
  return 0;
}
