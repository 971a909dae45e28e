#include "import/gltf/gltf_load.hpp"

#include "base/error.hpp"
#include "mesh/import_wire.hpp"
#include "mesh/opened_files.hpp"
#include "import/gltf/gltf_numbers.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <tiny_gltf.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <limits>
#include <string_view>
#include <vector>

namespace penumbra::scenes {
namespace {

/// What tinygltf may open; it asks through the callbacks below.
struct Confinement {
  int folder = -1;
  std::filesystem::path folder_name;
  bool allow_outside = false;
  std::string refused;  ///< the last name that leads outside

  /// Nothing if it may not be opened, or is no regular file.
  Descriptor open(const std::string& name) {
    constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
    Descriptor file;
    if (allow_outside) {
      file = Descriptor(::openat(folder, name.c_str(), kFlags));
    } else {
      mesh::OpenedBeneath beneath = mesh::open_beneath(folder, name, kFlags);
      if (beneath.error == EXDEV) refused = name;
      file = std::move(beneath.descriptor);
    }
    struct stat info {};
    const bool regular = file.is_open() && ::fstat(file.get(), &info) == 0 && S_ISREG(info.st_mode);
    return regular ? std::move(file) : Descriptor();
  }
};

tinygltf::FsCallbacks confined_files(Confinement& confinement) {
  tinygltf::FsCallbacks files{};
  files.FileExists = [](const std::string& name, void* user) {
    return static_cast<Confinement*>(user)->open(name).is_open();
  };
  files.ExpandFilePath = [](const std::string& name, void*) { return name; };  // no ~ and no $VARIABLES from a file
  files.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* error, const std::string& name, void* user) {
    const Descriptor file = static_cast<Confinement*>(user)->open(name);
    if (file.is_open()) {
      mesh::note_opened_file(static_cast<Confinement*>(user)->folder_name / name);
      const std::string content = mesh::read_content(file.get(), name);
      bytes->assign(content.begin(), content.end());
      return true;
    }
    *error = "cannot be read";
    return false;
  };
  files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  files.user_data = &confinement;
  return files;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// The chunks of a GLB must fit into the file: tinygltf reads up to eight bytes past its end otherwise. The first chunk
/// comes back: the JSON.
std::string_view check_glb(std::string_view bytes, const std::string& file) {
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
  return bytes.substr(kHeader + kChunkHeader, little_endian(bytes, kHeader));
}

/// A URI's percent signs undone.
std::string decoded(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const auto* end = uri.data() + i + 3;
    if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(uri.data() + i + 1, end, value, 16).ptr == end) {
      text += static_cast<char>(value);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

std::string without_line_ends(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  return mesh::printable(text);
}

/// What tinygltf says against skins without inverse bind matrices, which glTF 2.0 allows (3.7.3.1): they are then
/// identities. It reads the skin all the same.
void forgive_default_binds(std::string& error) {
  constexpr std::string_view kComplaint = "'inverseBindMatrices' property is missing in Skin.\n";
  for (auto at = error.find(kComplaint); at != std::string::npos; at = error.find(kComplaint))
    error.erase(at, kComplaint.size());
}

}  // namespace

bool is_from_blender(const tinygltf::Model& model) {
  return model.asset.generator.starts_with("Khronos glTF Blender I/O");
}

void load_gltf_model(const mesh::InputFile& input, bool allow_outside, tinygltf::Model& model) {
  const std::string name = input.name.string();
  const std::string bytes = mesh::read_content(input.content.get(), name);
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) throw InputError("{}: more than 4 GiB", name);

  Confinement confinement{input.folder.get(), std::filesystem::absolute(input.name).parent_path(), allow_outside, {}};
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(confined_files(confinement));
  // As they are: who uses a picture decodes it.
  parser.SetImageLoader(
      [](tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* data, int count,
         void*) {
        // tinygltf does not check that a view lies in its buffer: bytes of views are looked at later, by read_view.
        if (image->bufferView < 0) image->image.assign(data, data + count);
        return true;
      },
      nullptr);
  std::string error, warning;  // its warnings are about images only
  const auto size = static_cast<unsigned>(bytes.size());
  const std::string here;  // names are looked for from the folder's descriptor
  bool loaded = false;
  if (bytes.starts_with("glTF")) {
    check_gltf_numbers(check_glb(bytes, name), name);
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    loaded = parser.LoadBinaryFromMemory(&model, &error, &warning, data, size, here, tinygltf::NO_REQUIRE);
  } else {
    check_gltf_numbers(bytes, name);
    loaded = parser.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, here, tinygltf::NO_REQUIRE);
  }
  // Files of images are opened here, by the names that the file gives them and no other place.
  for (tinygltf::Image& image : model.images) {
    if (image.uri.empty() || !image.image.empty()) continue;
    const std::string file = decoded(image.uri);
    mesh::note_opened_file(confinement.folder_name / file);  // no output may take its place
    if (const Descriptor content = confinement.open(file); content.is_open()) {
      const std::string data = mesh::read_content(content.get(), file);
      image.image.assign(data.begin(), data.end());
    }
  }
  if (!confinement.refused.empty() && !loaded) {
    throw InputError("{}: it refers to {}, which is outside its folder; copy it there or pass --allow-outside", name,
                     mesh::printable(confinement.refused));
  }
  for (const std::string& extension : model.extensionsRequired) {
    if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression") {
      throw InputError("{}: /extensionsRequired: {} is not supported; export without compression", name, extension);
    }
  }
  forgive_default_binds(error);
  // It goes on after some errors, and leaves out what it could not understand: nothing may go missing silently.
  if (!loaded || !error.empty()) {
    throw InputError("{}: {}", name, error.empty() ? "it is no glTF file" : without_line_ends(error));
  }
}

}  // namespace penumbra::scenes
