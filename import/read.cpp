// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file by its format: common formats with this folder's own readers, which give lines in messages and keep
// all faces; the others with Assimp. The name's ending decides; if reading fails, the first bytes tell whether the
// ending is wrong.

#include "import/read.hpp"

#include "base/error.hpp"
#include "import/audit_3ds.hpp"
#include "import/audit_collada.hpp"
#include "import/3mf.hpp"
#include "import/amf.hpp"
#include "import/assimp_scene.hpp"
#include "import/obj.hpp"
#include "import/obj_materials.hpp"
#include "import/off.hpp"
#include "import/ply.hpp"
#include "import/stl.hpp"
#include "import/text.hpp"
#include "import/unicode.hpp"
#include "import/x3d.hpp"
#include "mesh/import_wire.hpp"
#include "mesh/opened_files.hpp"

#include <assimp/DefaultLogger.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>
#include <utility>

namespace penumbra::import {
namespace {

/// Folder in which Assimp believes the file to be: names below it are looked for in the file's folder and below.
constexpr std::string_view kVirtualFolder = "/mesh/";

/// Gives an importer read access to the file's own folder and below, and no write access: an OBJ's material library or
/// a scene's parts may name any path of the machine.
class FolderOnly : public Assimp::IOSystem {
 public:
  FolderOnly(const mesh::InputFile& input, const std::string& content)
      : folder_(input.folder.get()),
        folder_name_(std::filesystem::absolute(input.name).parent_path()),
        name_(input.name.filename().string()),
        content_(content) {}

  bool Exists(const char* name) const override { return is_own(name) || open(name).is_open(); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (!std::string_view(mode).starts_with('r')) return nullptr;
    if (is_own(name)) return stream_of(content_);
    const Descriptor file = open(name);
    if (!file.is_open()) return nullptr;
    mesh::note_opened_file(folder_name_ / inside(name));
    others_.push_back(std::make_unique<std::string>(mesh::read_content(file.get(), name)));
    return stream_of(*others_.back());
  }
  void Close(Assimp::IOStream* stream) override { std::unique_ptr<Assimp::IOStream>{stream}; }
  bool CreateDirectory(const std::string&) override { return false; }
  bool ChangeDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

 private:
  static std::string_view inside(std::string_view name) {
    if (name.starts_with(kVirtualFolder)) name.remove_prefix(kVirtualFolder.size());
    return name;
  }
  [[nodiscard]] bool is_own(std::string_view name) const { return inside(name) == name_; }
  [[nodiscard]] Descriptor open(std::string_view name) const {
    mesh::OpenedBeneath file = mesh::open_beneath(folder_, std::string(inside(name)), O_RDONLY | O_NONBLOCK | O_NOCTTY);
    struct stat info {};
    const bool regular = file.error == 0 && ::fstat(file.descriptor.get(), &info) == 0 && S_ISREG(info.st_mode);
    return regular ? std::move(file.descriptor) : Descriptor();
  }
  static Assimp::IOStream* stream_of(const std::string& content) {
    return std::make_unique<Assimp::MemoryIOStream>(reinterpret_cast<const std::uint8_t*>(content.data()),
                                                    content.size())
        .release();  // the handler that opened it closes it
  }

  int folder_;
  std::filesystem::path folder_name_;
  std::string name_;
  const std::string& content_;
  std::vector<std::unique_ptr<std::string>> others_;  ///< contents of files that the main file refers to
};

/// Collects the first few complaints of Assimp; most importers continue after one.
class Complaints : public Assimp::LogStream {
 public:
  void write(const char* message) override {
    constexpr std::size_t kMost = 8;
    std::string_view text = message;
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
    if (std::ranges::find(kept_, text) != kept_.end()) return;
    if (kept_.size() < kMost)
      kept_.emplace_back(text);
    else
      ++more_;
  }
  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    for (const std::string& text : kept_) notes.push_back("Assimp: " + text);
    if (more_ > 0) notes.push_back(fmt::format("Assimp: {} more messages of this sort", more_));
    return notes;
  }

 private:
  std::vector<std::string> kept_;
  std::size_t more_ = 0;
};

/// Returns the format recognised by the file's first bytes, for files with a misleading extension; nullopt if unknown.
std::optional<std::string_view> sniff(std::string_view content) {
  if (content.starts_with("glTF")) return ".glb";
  if (content.starts_with("ply\n") || content.starts_with("ply\r")) return ".ply";
  if (content.starts_with("solid ")) return ".stl";
  if (content.starts_with("OFF\n") || content.starts_with("COFF\n") || content.starts_with("NOFF\n")) return ".off";
  return std::nullopt;
}

/// Throws std::bad_alloc if the message reports exhausted memory: Assimp passes on only the text of such exceptions.
void rethrow_out_of_memory(std::string_view message) {
  for (const std::string_view sign : {"std::bad_alloc", "bad_array_new_length", "vector::", "basic_string::"}) {
    if (message.find(sign) != std::string_view::npos) throw std::bad_alloc();
  }
}

/// Reads with Assimp. `triangles`: number of triangles that the file is known to contain; fewer are an error.
mesh::ImportedMesh read_with_assimp(const mesh::InputFile& input, const std::string& content,
                                    std::uint64_t triangles = 0, SceneParts* parts = nullptr) {
  const std::string file = input.name.string(), extension = input.name.extension().string();
  if (lower_extension(input.name) == ".3ds") audit_3ds(content, file);
  Complaints complaints;
  Assimp::Logger* logger = Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
  logger->attachStream(&complaints, Assimp::Logger::Warn | Assimp::Logger::Err);
  struct KillLogger {
    Complaints* stream;
    ~KillLogger() {
      Assimp::DefaultLogger::get()->detachStream(stream, Assimp::Logger::Warn | Assimp::Logger::Err);
      Assimp::DefaultLogger::kill();
    }
  } const kill_logger{&complaints};

  const std::string base = input.name.filename().string();
  const std::string shown_to_assimp = std::string(kVirtualFolder) + base;
  Assimp::Importer importer;
  importer.SetIOHandler(std::make_unique<FolderOnly>(input, content).release());  // the importer takes ownership
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);            // no generated geometry for bones
  if (!extension.empty() && !importer.IsExtensionSupported(extension)) {
    throw InputError("{}: no importer for '{}' files; export the mesh as OBJ, PLY, STL or glTF 2.0 (.glb)", file,
                     extension);
  }
  // Post-processing is off: some of its steps drop faces.
  const aiScene* scene = importer.ReadFile(shown_to_assimp, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    std::string said = importer.GetErrorString();
    rethrow_out_of_memory(said);
    for (std::size_t at; (at = said.find(shown_to_assimp)) != std::string::npos;) {
      said.replace(at, shown_to_assimp.size(), base);
    }
    throw InputError("{}: {}", file, said.empty() ? "it could not be read" : said);
  }
  AssimpSceneOptions options;
  options.is_fbx = lower_extension(input.name) == ".fbx";
  options.triangles = triangles;
  options.parts = parts;
  if (parts != nullptr) {
    parts->has_orthographic = has_orthographic_camera(content);
    parts->white_is_grey = has_template_of_lamps(content);
  }
  mesh::ImportedMesh mesh = read_assimp_scene(*scene, file, options);
  if (parts == nullptr) {
    if (auto note = solid_materials_note(transparent_materials(*scene))) mesh.notes.push_back(*std::move(note));
    std::vector<std::string> lamps;
    for (const aiLight* light : std::span(scene->mLights, scene->mNumLights))
      lamps.push_back(mesh::printable(light->mName.C_Str()));
    if (auto note = left_out_lamps_note(lamps)) mesh.notes.push_back(*std::move(note));
  }
  const auto said = complaints.notes();
  mesh.notes.insert(mesh.notes.end(), said.begin(), said.end());
  return mesh;
}

/// Material libraries of an OBJ are not read, but belong to it: no output may overwrite them.
void note_material_libraries(std::string_view text, const std::filesystem::path& folder) {
  constexpr std::string_view kKeyword = "mtllib";
  for (std::size_t at = text.find(kKeyword); at != std::string_view::npos; at = text.find(kKeyword, at + 1)) {
    std::string_view rest = text.substr(at + kKeyword.size()), line;
    take_line(rest, line);
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    if (line.empty()) continue;
    mesh::note_opened_file(folder /
                           line);  // either one name with blanks or several names: files of both readings are noted
    for (std::string_view name; !(name = take_word(line)).empty();) mesh::note_opened_file(folder / name);
  }
}

mesh::ImportedMesh read_collada(const mesh::InputFile& input, const std::string& content, SceneParts* parts) {
  const std::string file = input.name.string();
  const std::uint64_t triangles = triangles_of_collada(content, file);
  return read_with_assimp(input, with_plain_material(with_named_cameras(without_leading_blanks(content, file))),
                          triangles, parts);
}

/// File formats that artists use, and that no library on this system reads.
void refuse_unknown(const std::string& extension, const std::string& file) {
  struct Format {
    std::string_view extension, name, instead;
  };
  constexpr std::string_view kScene = "export the scene as glTF 2.0 (.glb)";
  constexpr std::string_view kMesh = "export the mesh as X3D, OBJ or glTF 2.0 (.glb)";
  for (const Format& format : {Format{".usd", "USD", kScene},
                               {".usda", "USD", kScene},
                               {".usdc", "USD", kScene},
                               {".usdz", "USD", kScene},
                               {".abc", "Alembic", kScene},
                               {".wrl", "VRML", kMesh},
                               {".vrml", "VRML", kMesh}}) {
    if (extension == format.extension) throw InputError("{}: {} is not read; {}", file, format.name, format.instead);
  }
}

mesh::ImportedMesh read_as(const std::string& extension, const mesh::InputFile& input, const std::string& content,
                           bool with_places) {
  const std::string file = input.name.string();
  if (extension == ".obj") {
    note_material_libraries(content, std::filesystem::absolute(input.name).parent_path());
    mesh::ImportedMesh mesh = read_obj_text(content, file, with_places);
    if (auto note = solid_materials_note(transparent_materials(content, input))) mesh.notes.push_back(*std::move(note));
    return mesh;
  }
  if (extension == ".ply") return read_ply(content, file);
  if (extension == ".off") return read_off_text(content, file);
  if (extension == ".stl") return read_stl(content, file);
  if (extension == ".amf") return read_amf(content, file);
  if (extension == ".3mf") return read_3mf(content, file);
  if (extension == ".dae") return read_collada(input, content, nullptr);
  if (extension == ".x3d") return read_x3d(content, file);
  if (content.starts_with("FORM") && std::string_view(content).substr(4).find("LWOB") == 4) {
    throw InputError("{}: LWOB, the format of LightWave before version 6, is not supported; save it as LWO2 or OBJ",
                     file);
  }
  return read_with_assimp(input, content);
}

}  // namespace

mesh::ImportedMesh read_mesh(const mesh::InputFile& input, bool with_places) {
  const std::string file = input.name.string(), extension = lower_extension(input.name);
  refuse_unknown(extension, file);
  const std::string content = utf8_content(mesh::read_content(input.content.get(), file), extension, file);
  const auto looks_like = sniff(content);
  try {
    return read_as(extension, input, content, with_places);
  } catch (const InputError& error) {
    if (!looks_like || *looks_like == extension) throw;
    throw InputError("{}; its first bytes look like a {} file: is its name wrong?", error.what(), *looks_like);
  }
}

mesh::ImportedMesh read_scene_parts(const mesh::InputFile& input, SceneParts& parts) {
  const std::string file = input.name.string(), extension = lower_extension(input.name);
  const std::string content = utf8_content(mesh::read_content(input.content.get(), file), extension, file);
  if (extension == ".dae") return read_collada(input, content, &parts);
  return read_with_assimp(input, content, 0, &parts);
}

}  // namespace penumbra::import
