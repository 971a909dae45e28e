#include "scenes/gltf_load.hpp"

#include "base/error.hpp"
#include "mesh/opened_files.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <system_error>
#include <vector>

namespace penumbra::scenes {
namespace {

/// What tinygltf may open; it asks through the callbacks below.
struct Confinement {
  std::filesystem::path folder;
  bool allow_outside = false;
  std::string refused;  ///< the last existing file that lies outside

  bool allows(const std::string& name) {
    std::error_code error;
    const auto path = std::filesystem::weakly_canonical(name, error);
    if (error || !std::filesystem::is_regular_file(path, error)) return false;
    if (allow_outside || std::ranges::mismatch(folder, path).in1 == folder.end()) return true;
    refused = name;
    return false;
  }
};

bool read_bytes(const std::string& name, std::vector<unsigned char>& bytes) {
  mesh::note_opened_file(name);
  std::error_code error;
  const auto size = std::filesystem::file_size(name, error);
  std::ifstream stream(name, std::ios::binary);
  if (error || !stream) return false;
  bytes.resize(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  return static_cast<bool>(stream);
}

tinygltf::FsCallbacks confined_files(Confinement& confinement) {
  tinygltf::FsCallbacks files{};
  files.FileExists = [](const std::string& name, void* user) { return static_cast<Confinement*>(user)->allows(name); };
  files.ExpandFilePath = [](const std::string& name, void*) { return name; };  // no ~ and no $VARIABLES from a file
  files.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* error, const std::string& name, void* user) {
    if (static_cast<Confinement*>(user)->allows(name) && read_bytes(name, *bytes)) return true;
    *error = "cannot be read";
    return false;
  };
  files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  files.user_data = &confinement;
  return files;
}

std::uint32_t little_endian(const std::vector<unsigned char>& bytes, std::size_t at) {
  return bytes[at] | std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at + 2]} << 16 |
         std::uint32_t{bytes[at + 3]} << 24;
}

/// The chunks of a GLB must fit into the file: tinygltf reads up to eight bytes past its end otherwise.
void check_glb(const std::vector<unsigned char>& bytes, const std::string& file) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader + kChunkHeader)
    throw InputError("{}: a GLB of {} bytes; it is truncated", file, bytes.size());
  const std::uint32_t version = little_endian(bytes, 4), length = little_endian(bytes, 8);
  if (version != 2) throw InputError("{}: GLB version {}; expected 2. Export it again as glTF 2.0", file, version);
  if (length > bytes.size()) {
    throw InputError("{}: the GLB says it has {} bytes, but the file has {}; it is truncated", file, length,
                     bytes.size());
  }
  for (std::size_t at = kHeader; at < length;) {
    const std::size_t left = length - at;
    const std::size_t chunk = left < kChunkHeader ? 0 : little_endian(bytes, at);
    if (left < kChunkHeader || chunk > left - kChunkHeader) {
      throw InputError("{}: the GLB chunk at byte {} reaches beyond the file's {} bytes; it is truncated or damaged",
                       file, at, length);
    }
    at += kChunkHeader + chunk;
  }
}

std::string without_line_ends(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

void load_gltf_model(const std::filesystem::path& file, bool allow_outside, tinygltf::Model& model) {
  const std::string name = file.string();
  std::vector<unsigned char> bytes;
  if (!read_bytes(name, bytes)) throw InputError("{}: it cannot be read", name);
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) throw InputError("{}: more than 4 GiB", name);

  Confinement confinement{std::filesystem::weakly_canonical(file).parent_path(), allow_outside, {}};
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(confined_files(confinement));
  parser.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  std::string error, warning;  // its warnings are about images only
  const auto size = static_cast<unsigned>(bytes.size());
  const std::string folder = confinement.folder.string();
  bool loaded = false;
  if (size >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) {
    check_glb(bytes, name);
    loaded = parser.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, folder, tinygltf::NO_REQUIRE);
  } else {
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    loaded = parser.LoadASCIIFromString(&model, &error, &warning, text, size, folder, tinygltf::NO_REQUIRE);
  }
  // glTF 1.0 has objects where 2.0 has arrays: tinygltf then finds nothing, which is not the message that helps.
  if (!model.asset.version.empty() && !model.asset.version.starts_with("2.")) {
    throw InputError("{}: /asset/version: glTF {} is not supported; export it again as glTF 2.0", name,
                     model.asset.version);
  }
  if (!confinement.refused.empty() && !loaded) {
    throw InputError("{}: it refers to {}, which is outside its folder; copy it there or pass --allow-outside", name,
                     confinement.refused);
  }
  for (const std::string& extension : model.extensionsRequired) {
    if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression") {
      throw InputError("{}: /extensionsRequired: {} is not supported; export without compression", name, extension);
    }
  }
  // It goes on after some errors, and leaves out what it could not understand: nothing may go missing in silence.
  if (!loaded || !error.empty()) {
    throw InputError("{}: {}", name, error.empty() ? "it is no glTF file" : without_line_ends(error));
  }
  if (model.asset.version.empty()) throw InputError("{}: /asset/version is missing; this is no glTF 2.0 file", name);
}

}  // namespace penumbra::scenes
