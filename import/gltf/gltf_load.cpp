// SPDX-License-Identifier: Apache-2.0
// Parses a glTF or GLB file with tinygltf, which may open files only in the file's own folder and below. Before
// tinygltf sees the JSON, its integers are checked, its URIs are resolved (escaped or not), and constructs that
// tinygltf misreads are converted.

#include "import/gltf/gltf_load.hpp"

#include "base/error.hpp"
#include "base/utf8.hpp"
#include "mesh/import_wire.hpp"
#include "mesh/opened_files.hpp"
#include "import/gltf/glb_chunks.hpp"
#include "import/gltf/gltf_numbers.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::import {
namespace {

/// Files that tinygltf may open, through the callbacks below.
struct Confinement {
  int folder = -1;
  std::filesystem::path folder_name;
  bool allow_outside = false;
  std::string refused;  ///< the last name that leads outside of the folder
  /// Bytes that the buffers take from each named file, in buffer order: a file may be longer.
  std::map<std::string, std::deque<std::size_t>> lengths;

  /// Opens a file. Returns a closed descriptor if the file may not be opened, or is not a regular file.
  Descriptor open(const std::string& name) {
    Descriptor file = open_as_named(name);
    if (file.is_open() || name.find('\\') == std::string::npos) return file;
    // Names written on Windows have backslashes, which browsers take for slashes.
    std::string meant = name;
    std::ranges::replace(meant, '\\', '/');
    file = open_as_named(meant);
    if (file.is_open()) mesh::note_opened_file(folder_name / meant);  // no output may overwrite the file
    return file;
  }

 private:
  Descriptor open_as_named(const std::string& name) {
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
  files.ExpandFilePath = [](const std::string& name, void*) { return name; };  // no ~ and no $VARIABLES in names from a
                                                                               // file
  files.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* error, const std::string& name, void* user) {
    auto& confined = *static_cast<Confinement*>(user);
    const Descriptor file = confined.open(name);
    if (file.is_open()) {
      mesh::note_opened_file(confined.folder_name / name);
      std::string content = mesh::read_content(file.get(), name);
      if (auto& lengths = confined.lengths[name]; !lengths.empty()) {
        if (content.size() > lengths.front()) content.resize(lengths.front());
        lengths.pop_front();
      }
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

/// Returns the byte of a percent escape at the text's beginning; nullopt if there is none, or one of NUL, which no
/// file's name has.
std::optional<char> escaped_byte(std::string_view text) {
  unsigned value = 0;
  if (text.size() < 3 || text[0] != '%') return std::nullopt;
  const bool is_hex = std::from_chars(text.data() + 1, text.data() + 3, value, 16).ptr == text.data() + 3;
  return is_hex && value != 0 ? std::optional(static_cast<char>(value)) : std::nullopt;
}

/// Decodes a URI's percent escapes. A percent sign that begins no escape stands for itself.
std::string decoded(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto byte = escaped_byte(uri.substr(i));
    text += byte.value_or(uri[i]);
    if (byte) i += 2;
  }
  return text;
}

/// Returns whether each percent sign begins an escape.
bool is_escaped(std::string_view uri) {
  for (std::size_t at = uri.find('%'); at != std::string_view::npos; at = uri.find('%', at + 1)) {
    if (!escaped_byte(uri.substr(at))) return false;
  }
  return true;
}

/// Returns a message without line ends, without the parser's numbers in brackets, and without the content of data URIs:
/// their beginnings are enough, and text after them is dropped.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  if (text.starts_with('[')) text.erase(0, std::min(text.find("] "), text.size() - 2) + 2);
  constexpr std::size_t kHead = 40;
  if (const std::size_t at = text.find("data:"); at != std::string::npos && text.size() > at + kHead) {
    text.resize(std::min(text.find(',', at), at + kHead));
    text += "…";
  }
  return mesh::printable(text);
}

/// Removes tinygltf's complaint about skins without inverse bind matrices, which glTF 2.0 allows (3.7.3.1): they are
/// identities. tinygltf reads such skins anyway.
void forgive_default_binds(std::string& error) {
  constexpr std::string_view kComplaint = "'inverseBindMatrices' property is missing in Skin.\n";
  for (auto at = error.find(kComplaint); at != std::string::npos; at = error.find(kComplaint))
    error.erase(at, kComplaint.size());
}

/// Determines which file each URI with percent signs means: the decoded name, or the name as it stands if only that
/// file exists, since some exporters do not escape a "50%20.bin". Writes its URI so that tinygltf, which decodes a
/// "100%.bin" to other letters, finds the file. Returns whether a URI changed.
bool settle_names(nlohmann::json& document, Confinement& confinement) {
  bool changed = false;
  for (const char* const list : {"buffers", "images"}) {
    const auto found = document.find(list);
    if (found == document.end() || !found->is_array()) continue;
    for (nlohmann::json& owner : *found) {
      if (!owner.is_object() || !owner.contains("uri") || !owner["uri"].is_string()) continue;
      auto& uri = owner["uri"].get_ref<std::string&>();
      if (uri.starts_with("data:") || uri.find('%') == std::string::npos) continue;
      const std::string name = decoded(uri);
      const bool as_it_stands = !confinement.open(name).is_open() && confinement.open(uri).is_open();
      if (is_escaped(uri) && !as_it_stands) continue;
      std::string escaped;
      for (const char letter : as_it_stands ? uri : name)
        escaped += letter == '%' ? "%25" : letter == '+' ? "%2B" : std::string(1, letter);
      uri = escaped;
      changed = true;
    }
  }
  return changed;
}

/// Notes the number of bytes that each buffer takes from its file.
void note_lengths(const nlohmann::json& document, Confinement& confinement) {
  const auto buffers = document.find("buffers");
  if (buffers == document.end() || !buffers->is_array()) return;
  for (const nlohmann::json& buffer : *buffers) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    if (!buffer.contains("byteLength") || !buffer["byteLength"].is_number_unsigned()) continue;
    confinement.lengths[decoded(buffer["uri"].get_ref<const std::string&>())].push_back(
        buffer["byteLength"].get<std::size_t>());
  }
}

/// Returns JSON in which the escape \\xe9 replaces a byte that is not UTF-8; in the parsed string this is the text
/// \xe9.
std::string with_escaped_bytes(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0)
      valid += fmt::format("\\\\x{:02x}", static_cast<unsigned char>(text.front()));
    else
      valid += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return valid;
}

/// Returns the file's checked JSON; throws the parser's message if it is not JSON. `is_utf8` becomes false if a name
/// had to be changed.
nlohmann::json document_of(std::string_view text, const std::string& file, bool& is_utf8) {
  try {
    nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    if (document.is_discarded()) {  // names in a code page of Windows, or no JSON at all
      const std::string valid = with_escaped_bytes(text);
      is_utf8 = valid == text;
      document = nlohmann::json::parse(valid);
    }
    if (!document.is_object()) throw InputError("{}: it is no glTF file: its JSON is no object", file);
    check_gltf_numbers(document, file);
    return document;
  } catch (const nlohmann::json::exception& error) {
    throw InputError("{}: {}", file, one_line(error.what()));
  }
}

}  // namespace

TakenOut load_gltf_model(const mesh::InputFile& input, const scenes::ReadOptions& options, tinygltf::Model& model) {
  const std::string name = input.name.string();
  std::string bytes = mesh::read_content(input.content.get(), name);
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) throw InputError("{}: more than 4 GiB", name);

  Confinement confinement{
      input.folder.get(), std::filesystem::absolute(input.name).parent_path(), options.allow_outside, {}, {}};
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(confined_files(confinement));
  // Keeps images encoded: the code that uses a picture decodes it.
  parser.SetImageLoader(
      [](tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* data, int count,
         void*) {
        // tinygltf does not check that a view lies in its buffer: bytes of views are read later, by read_view.
        if (image->bufferView < 0) image->image.assign(data, data + count);
        return true;
      },
      nullptr);
  std::string error, warning;  // tinygltf's warnings are about images only
  TakenOut taken_out;
  {
    const bool binary = bytes.starts_with("glTF");
    const GlbChunks chunks = binary ? glb_chunks(bytes, name) : GlbChunks{bytes, {}};
    bool is_utf8 = true;
    nlohmann::json document = document_of(chunks.json, name, is_utf8);
    bool mended = settle_names(document, confinement);
    mended |= mend_gltf(document, name, options.lenient, taken_out) || !is_utf8;
    taken_out.no_utf8 = !is_utf8;
    note_lengths(document, confinement);
    const std::string text = mended ? document.dump() : std::string();
    if (binary && (mended || !chunks.strict))
      bytes = glb_of(mended ? std::string_view(text) : chunks.json, chunks.binary);
    else if (mended)
      bytes = text;
  }
  const auto size = static_cast<unsigned>(bytes.size());
  const std::string here;  // names are resolved from the folder's descriptor
  bool loaded = false;
  if (bytes.starts_with("glTF")) {
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    loaded = parser.LoadBinaryFromMemory(&model, &error, &warning, data, size, here, tinygltf::NO_REQUIRE);
  } else {
    loaded = parser.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, here, tinygltf::NO_REQUIRE);
  }
  // Image files are opened here, by the names in the file and no other path.
  for (tinygltf::Image& image : model.images) {
    const std::string file = decoded(image.uri);
    image.uri = file;  // in messages the file's own name, not a URI
    if (file.empty() || !image.image.empty()) continue;
    mesh::note_opened_file(confinement.folder_name / file);  // no output may overwrite the file
    if (const Descriptor content = confinement.open(file); content.is_open()) {
      const std::string data = mesh::read_content(content.get(), file);
      image.image.assign(data.begin(), data.end());
    }
  }
  if (!confinement.refused.empty() && !loaded) {
    throw InputError("{}: it refers to {}, which is outside its folder; copy it there or pass --allow-outside", name,
                     mesh::printable(confinement.refused));
  }
  forgive_default_binds(error);
  // tinygltf continues after some errors, and leaves out what it did not understand: nothing may go missing silently.
  if (!loaded || !error.empty()) {
    throw InputError("{}: {}", name, error.empty() ? "it is no glTF file" : one_line(error));
  }
  return taken_out;
}

}  // namespace penumbra::import
