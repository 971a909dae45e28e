#include "import/read.hpp"

#include "base/error.hpp"
#include "import/audit_3ds.hpp"
#include "import/3mf.hpp"
#include "import/amf.hpp"
#include "import/faces.hpp"
#include "import/obj.hpp"
#include "import/off.hpp"
#include "import/ply.hpp"
#include "import/stl.hpp"
#include "import/text.hpp"
#include "import/unicode.hpp"
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

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <optional>

namespace penumbra::mesh {
namespace {

/// Where Assimp believes the file to be: what it asks for below this is looked for in the file's folder and below.
constexpr std::string_view kVirtualFolder = "/mesh/";

/// Lets an importer read the file's own folder and what is below it, and write nothing: an OBJ's material library or
/// a scene's parts may name any path of the machine.
class FolderOnly : public Assimp::IOSystem {
 public:
  FolderOnly(const InputFile& input, const std::string& content)
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
    note_opened_file(folder_name_ / inside(name));
    others_.push_back(std::make_unique<std::string>(read_content(file.get(), name)));
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
    OpenedBeneath file = open_beneath(folder_, std::string(inside(name)), O_RDONLY | O_NONBLOCK | O_NOCTTY);
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
  std::vector<std::unique_ptr<std::string>> others_;  ///< contents of files that the first one names
};

/// The first few complaints that Assimp makes while it reads; most importers go on after one.
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

glm::dmat4 to_glm(const aiMatrix4x4& m) {  // Assimp's letters are rows, glm's constructor takes columns
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

/// Adds every mesh of the node tree, where the nodes put it, to one soup.
class SceneReader {
 public:
  SceneReader(const aiScene& scene, std::string file) : scene_(scene), file_(std::move(file)), faces_(mesh_.soup) {}

  ImportedMesh read() {
    struct Visit {
      const aiNode* node;
      glm::dmat4 to_world;
    };
    std::vector<bool> shown(scene_.mNumMeshes, false);
    std::vector<Visit> stack{{scene_.mRootNode, to_glm(scene_.mRootNode->mTransformation)}};
    while (!stack.empty()) {  // no recursion: a file may nest a million nodes
      const Visit visit = stack.back();
      stack.pop_back();
      for (const unsigned number : std::span(visit.node->mMeshes, visit.node->mNumMeshes)) {
        if (number >= scene_.mNumMeshes)
          throw InputError("{}: a node names mesh {} of {}", file_, number, scene_.mNumMeshes);
        shown[number] = true;
        add(*scene_.mMeshes[number], visit.to_world);
      }
      for (unsigned i = visit.node->mNumChildren; i-- > 0;) {  // last first, so that they come off in the file's order
        const aiNode* child = visit.node->mChildren[i];
        broken_tree_ = broken_tree_ || child == nullptr;
        if (child != nullptr) stack.push_back({child, visit.to_world * to_glm(child->mTransformation)});
      }
    }
    add_hidden(shown);
    if (mesh_.soup.triangles.empty()) {
      throw InputError("{}: there are no triangles in it ({})", file_, faces_.instead_of_surfaces());
    }
    const auto notes = faces_.notes();
    mesh_.notes.insert(mesh_.notes.end(), notes.begin(), notes.end());
    note_what_was_ignored();
    note_lost_precision();
    return std::move(mesh_);
  }

 private:
  /// Meshes that no node shows are not part of what the file depicts, unless the importer delivers a tree with holes
  /// (Assimp's RAW importer does) or with no mesh at all.
  void add_hidden(const std::vector<bool>& shown) {
    const auto hidden = std::ranges::count(shown, false);
    if (hidden == 0) return;
    if (static_cast<std::size_t>(hidden) < shown.size() && !broken_tree_) {
      mesh_.notes.push_back(fmt::format("{} of {} meshes skipped: no node shows them", hidden, shown.size()));
      return;
    }
    mesh_.notes.push_back(fmt::format("{} of {} meshes taken as they are: no node shows them", hidden, shown.size()));
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
      if (!shown[i]) add(*scene_.mMeshes[i], glm::dmat4(1));
    }
  }

  void add(const aiMesh& part, const glm::dmat4& to_world) {
    auto& positions = mesh_.soup.positions;
    const std::size_t first = positions.size();
    if (first + part.mNumVertices > std::numeric_limits<std::uint32_t>::max()) {
      throw InputError("{}: more than 4,294,967,295 vertices", file_);
    }
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      const glm::dvec3 p(to_world * glm::dvec4(v.x, v.y, v.z, 1));
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        throw InputError("{}: vertex {}{} is not finite: ({}, {}, {})", file_, i, of_part(part), v.x, v.y, v.z);
      }
      for (const float x : {v.x, v.y, v.z}) farthest_ = std::max(farthest_, std::abs(x));
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
      positions.push_back(p);
    }
    // A mirroring transform turns every triangle inside out; swapping its corners' order keeps the outside outside.
    const bool mirrored = glm::determinant(to_world) < 0;
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      corners_.clear();
      for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) {
        if (index >= part.mNumVertices) {
          throw InputError("{}: face {}{} names vertex {}, but there are only {} (numbered from 0)", file_, f,
                           of_part(part), index, part.mNumVertices);
        }
        corners_.push_back(static_cast<std::uint32_t>(first) + index);
      }
      if (mirrored) std::ranges::reverse(corners_);
      faces_.add(corners_);
    }
    mirrored_ += mirrored ? 1 : 0;
    normals_ += part.HasNormals() ? 1 : 0;
    uvs_ += part.HasTextureCoords(0) ? 1 : 0;
    colors_ += part.HasVertexColors(0) ? 1 : 0;
    skins_ += part.HasBones() ? 1 : 0;
    morphs_ += part.mNumAnimMeshes > 0 ? 1 : 0;
  }

  /// " of mesh 'name'", where the file has several.
  [[nodiscard]] std::string of_part(const aiMesh& part) const {
    return scene_.mNumMeshes > 1 ? fmt::format(" of mesh '{}'", part.mName.C_Str()) : "";
  }

  void note_what_was_ignored() {
    std::string ignored;
    const auto mention = [&](std::uint64_t count, std::string_view what) {
      if (count > 0) ignored += fmt::format("{}{} of {} meshes", ignored.empty() ? "" : ", ", what, count);
    };
    mention(normals_, "vertex normals");
    mention(uvs_, "texture coordinates");
    mention(colors_, "vertex colours");
    mention(skins_, "bones");
    mention(morphs_, "morph targets");
    if (!ignored.empty()) mesh_.notes.push_back("ignored: " + ignored);
    if (mirrored_ > 0) {
      mesh_.notes.push_back(
          fmt::format("{} meshes mirrored by their nodes' transforms: windings reversed, so that the "
                      "outside stays outside",
                      mirrored_));
    }
  }

  /// Assimp holds positions in single precision. That is worth a word where the grid of floats at the mesh's distance
  /// from zero shows against its size: coarser than a 16384th of the diagonal, a 32nd of a pixel in a 512-pixel image.
  void note_lost_precision() {
    const double spacing = std::nextafter(farthest_, std::numeric_limits<float>::infinity()) - farthest_;
    const double diagonal = glm::length(high_ - low_);
    if (spacing * 16384 > diagonal && diagonal > 0) {
      mesh_.notes.push_back(
          fmt::format("coordinates were rounded to single precision: steps of {:.2g} on a mesh of size "
                      "{:.2g}; store it nearer to zero and move it by a transform",
                      spacing, diagonal));
    }
  }

  const aiScene& scene_;
  std::string file_;
  ImportedMesh mesh_;
  FaceCollector faces_;
  std::vector<std::uint32_t> corners_;
  bool broken_tree_ = false;
  float farthest_ = 0;
  glm::dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
  std::uint64_t mirrored_ = 0, normals_ = 0, uvs_ = 0, colors_ = 0, skins_ = 0, morphs_ = 0;
};

std::string supported_extensions(const Assimp::Importer& importer) {
  std::string list;
  importer.GetExtensionList(list);
  return list;
}

/// What the file's first bytes say it is, for files whose name says something else.
std::optional<std::string_view> sniff(std::string_view content) {
  if (content.starts_with("glTF")) return ".glb";
  if (content.starts_with("ply\n") || content.starts_with("ply\r")) return ".ply";
  if (content.starts_with("solid ")) return ".stl";
  if (content.starts_with("OFF\n") || content.starts_with("COFF\n") || content.starts_with("NOFF\n")) return ".off";
  return std::nullopt;
}

/// What Assimp says when it runs out of memory is what the standard library calls its exceptions.
void rethrow_out_of_memory(std::string_view message) {
  for (const std::string_view sign : {"std::bad_alloc", "bad_array_new_length", "vector::", "basic_string::"}) {
    if (message.find(sign) != std::string_view::npos) throw std::bad_alloc();
  }
}

ImportedMesh read_with_assimp(const InputFile& input, const std::string& content) {
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
  importer.SetIOHandler(std::make_unique<FolderOnly>(input, content).release());  // it takes ownership
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);            // no made-up geometry for bones
  if (!extension.empty() && !importer.IsExtensionSupported(extension)) {
    throw InputError("{}: no importer for '{}' files; known are {}", file, extension, supported_extensions(importer));
  }
  // No post-processing: some of its steps drop faces.
  const aiScene* scene = importer.ReadFile(shown_to_assimp, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    std::string said = importer.GetErrorString();
    rethrow_out_of_memory(said);
    for (std::size_t at; (at = said.find(shown_to_assimp)) != std::string::npos;) {
      said.replace(at, shown_to_assimp.size(), base);
    }
    throw InputError("{}: {}", file, said.empty() ? "it could not be read" : said);
  }
  ImportedMesh mesh = SceneReader(*scene, file).read();
  const auto said = complaints.notes();
  mesh.notes.insert(mesh.notes.end(), said.begin(), said.end());
  return mesh;
}

/// An OBJ's material libraries are not read, but they belong to it: no output may take their place.
void note_material_libraries(std::string_view text, const std::filesystem::path& folder) {
  constexpr std::string_view kKeyword = "mtllib";
  for (std::size_t at = text.find(kKeyword); at != std::string_view::npos; at = text.find(kKeyword, at + 1)) {
    std::string_view rest = text.substr(at + kKeyword.size()), line;
    take_line(rest, line);
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    if (line.empty()) continue;
    note_opened_file(folder / line);  // one name with blanks, or several names: both are meant in files that exist
    for (std::string_view name; !(name = take_word(line)).empty();) note_opened_file(folder / name);
  }
}

ImportedMesh read_as(const std::string& extension, const InputFile& input, const std::string& content) {
  const std::string file = input.name.string();
  if (extension == ".obj") {
    note_material_libraries(content, std::filesystem::absolute(input.name).parent_path());
    return read_obj_text(content, file);
  }
  if (extension == ".ply") return read_ply(content, file);
  if (extension == ".off") return read_off_text(content, file);
  if (extension == ".stl") return read_stl(content, file);
  if (extension == ".amf") return read_amf(content, file);
  if (extension == ".3mf") return read_3mf(content, file);
  if (content.starts_with("FORM") && std::string_view(content).substr(4).find("LWOB") == 4) {
    throw InputError("{}: LWOB, the format of LightWave before version 6, is not supported; save it as LWO2 or OBJ",
                     file);
  }
  return read_with_assimp(input, content);
}

}  // namespace

ImportedMesh read_mesh(const InputFile& input) {
  const std::string file = input.name.string(), extension = lower_extension(input.name);
  const std::string content = utf8_content(read_content(input.content.get(), file), extension, file);
  const auto looks_like = sniff(content);
  try {
    return read_as(extension, input, content);
  } catch (const InputError& error) {
    if (!looks_like || *looks_like == extension) throw;
    throw InputError("{}; its first bytes look like a {} file: is its name wrong?", error.what(), *looks_like);
  }
}

}  // namespace penumbra::mesh
