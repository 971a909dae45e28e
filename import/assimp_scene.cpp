// SPDX-License-Identifier: Apache-2.0
// Flattens what Assimp read: walks the nodes, puts each mesh into world space as often as it is shown, turns mirrored
// triangles, and keeps vertex and face numbers of the file for messages.

#include "import/assimp_scene.hpp"

#include "base/error.hpp"
#include "import/faces.hpp"

#include <assimp/scene.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::import {
namespace {

glm::dmat4 to_glm(const aiMatrix4x4& m) {  // Assimp's letters are rows, glm's constructor takes columns
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

class SceneReader {
 public:
  /// `to_scene` transforms the file's root to the scene's units and axes.
  SceneReader(const aiScene& scene, std::string file, const glm::dmat4& to_scene, const AssimpSceneOptions& options)
      : scene_(scene),
        file_(std::move(file)),
        to_scene_(to_scene),
        triangles_(options.triangles),
        parts_of_scene_(options.parts),
        faces_(mesh_.soup) {}

  mesh::ImportedMesh read() {
    struct Visit {
      const aiNode* node;
      glm::dmat4 to_world;
    };
    std::vector<bool> shown(scene_.mNumMeshes, false);
    std::vector<Visit> stack{{scene_.mRootNode, to_scene_ * to_glm(scene_.mRootNode->mTransformation)}};
    while (!stack.empty()) {  // no recursion: a file may nest a million nodes
      const Visit visit = stack.back();
      stack.pop_back();
      const std::string name = visit.node->mName.C_Str();
      places_.try_emplace(name, visit.to_world);
      for (unsigned i = 0; i < visit.node->mNumMeshes; ++i) {
        const unsigned number = visit.node->mMeshes[i];
        if (number >= scene_.mNumMeshes)
          throw InputError("{}: a node names mesh {} of {}", file_, number, scene_.mNumMeshes);
        shown[number] = true;
        add(*scene_.mMeshes[number], visit.to_world, visit.node->mNumMeshes > 1 ? fmt::format("{}/{}", name, i) : name);
      }
      for (unsigned i = visit.node->mNumChildren; i-- > 0;) {  // pushed last first, so that they are popped in the
                                                               // file's order
        const aiNode* child = visit.node->mChildren[i];
        broken_tree_ = broken_tree_ || child == nullptr;
        if (child != nullptr) stack.push_back({child, visit.to_world * to_glm(child->mTransformation)});
      }
    }
    add_hidden(shown);
    faces_.require_all(held_, file_);
    if (faces_.triangles() < triangles_) {
      throw InputError(
          "{}: its polygons consist of {} triangles in all, but Assimp delivers {}; save it as OBJ, PLY or glTF", file_,
          triangles_, faces_.triangles());
    }
    settle_unused_vertices(mesh_, [&](std::uint32_t v) { refuse_vertex(v); });
    if (mesh_.soup.triangles.empty()) {
      throw InputError("{}: there are no triangles in it ({})", file_, faces_.instead_of_surfaces());
    }
    const auto notes = faces_.notes();
    mesh_.notes.insert(mesh_.notes.end(), notes.begin(), notes.end());
    note_what_was_ignored();
    note_lost_precision();
    if (parts_of_scene_ != nullptr) add_lamps_and_lenses(scene_, places_, *parts_of_scene_);
    return std::move(mesh_);
  }

 private:
  /// Meshes that no node shows are not part of the depicted scene, unless the importer delivers an incomplete tree
  /// (Assimp's RAW importer does) or one without any mesh.
  void add_hidden(const std::vector<bool>& shown) {
    const auto hidden = std::ranges::count(shown, false);
    if (hidden == 0) return;
    if (static_cast<std::size_t>(hidden) < shown.size() && !broken_tree_) {
      mesh_.notes.push_back(fmt::format("{} of {} meshes skipped: no node shows them", hidden, shown.size()));
      return;
    }
    mesh_.notes.push_back(fmt::format("{} of {} meshes taken as they are: no node shows them", hidden, shown.size()));
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
      if (!shown[i]) add(*scene_.mMeshes[i], to_scene_, scene_.mMeshes[i]->mName.C_Str());
    }
  }

  void add(const aiMesh& part, const glm::dmat4& to_world, const std::string& name) {
    auto& positions = mesh_.soup.positions;
    const std::size_t first = positions.size();
    if (parts_of_scene_ != nullptr) add_looks(part, to_world, name);
    if (first + part.mNumVertices > std::numeric_limits<std::uint32_t>::max()) {
      throw InputError("{}: more than 4,294,967,295 vertices", file_);
    }
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      const glm::dvec3 p(to_world * glm::dvec4(v.x, v.y, v.z, 1));
      positions.push_back(p);
      // an error only if a face uses the position
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
      for (const float x : {v.x, v.y, v.z}) farthest_ = std::max(farthest_, std::abs(x));
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
    parts_.emplace_back(first, &part);
    held_ += part.mNumFaces;
    // A mirroring transform turns every triangle inside out; swapping the order of its corners keeps the outside
    // outside.
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

  /// Appends the mesh's appearance; to be called before its positions and triangles are added.
  void add_looks(const aiMesh& part, const glm::dmat4& to_world, const std::string& name) {
    parts_of_scene_->parts.push_back(part_of(scene_, part, name));
    parts_of_scene_->parts.back().first_triangle = mesh_.soup.triangles.size();
    const glm::dmat3 turned = glm::transpose(glm::inverse(glm::dmat3(to_world)));
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      glm::dvec3 normal(0);
      if (part.HasNormals()) {
        const aiVector3D& n = part.mNormals[i];
        normal = turned * glm::dvec3(n.x, n.y, n.z);
        const double length = glm::length(normal);
        normal = std::isfinite(length) && length > 0 ? normal / length : glm::dvec3(0);
      }
      parts_of_scene_->normals.emplace_back(normal);
      glm::dvec2 place = mesh::kNoPlace;
      if (parts_of_scene_->uv < AI_MAX_NUMBER_OF_TEXTURECOORDS && part.HasTextureCoords(parts_of_scene_->uv)) {
        const aiVector3D& uv = part.mTextureCoords[parts_of_scene_->uv][i];
        if (std::abs(uv.x) < 1e6F && std::abs(uv.y) < 1e6F) place = {uv.x, 1 - static_cast<double>(uv.y)};
      }
      parts_of_scene_->places.push_back(place);
    }
  }

  [[noreturn]] void refuse_vertex(std::uint32_t vertex) const {
    const auto next = std::ranges::upper_bound(parts_, vertex, {}, &std::pair<std::size_t, const aiMesh*>::first);
    const auto& [first, part] = *std::prev(next);
    const aiVector3D& v = part->mVertices[vertex - first];
    throw InputError("{}: vertex {}{} is not finite: ({}, {}, {})", file_, vertex - first, of_part(*part), v.x, v.y,
                     v.z);
  }

  /// Returns " of mesh 'name'" if the file has several meshes, else an empty text.
  [[nodiscard]] std::string of_part(const aiMesh& part) const {
    return scene_.mNumMeshes > 1 ? fmt::format(" of mesh '{}'", part.mName.C_Str()) : "";
  }

  void note_what_was_ignored() {
    std::string ignored;
    const auto mention = [&](std::uint64_t count, std::string_view what) {
      if (count > 0) ignored += fmt::format("{}{} of {} meshes", ignored.empty() ? "" : ", ", what, count);
    };
    if (parts_of_scene_ == nullptr) mention(normals_, "vertex normals");
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

  /// Assimp stores positions in single precision. A note is added if the spacing of floats at the mesh's distance from
  /// zero is visible at the mesh's size: coarser than a 16384th of the diagonal, a 32nd of a pixel in a 512-pixel
  /// image.
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
  glm::dmat4 to_scene_;
  std::uint64_t triangles_;
  SceneParts* parts_of_scene_;
  std::map<std::string, glm::dmat4, std::less<>> places_;  // by node name
  mesh::ImportedMesh mesh_;
  FaceCollector faces_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::pair<std::size_t, const aiMesh*>>
      parts_;               ///< the first position of each mesh, once for each time the mesh is shown
  std::uint64_t held_ = 0;  ///< number of faces of these
  bool broken_tree_ = false;
  float farthest_ = 0;
  glm::dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
  std::uint64_t mirrored_ = 0, normals_ = 0, uvs_ = 0, colors_ = 0, skins_ = 0, morphs_ = 0;
};

/// Unit and axes of an FBX file, which Assimp reads but does not apply: lengths become metres, as in Blender, and the
/// up axis becomes Y.
class FbxFrame {
 public:
  explicit FbxFrame(const aiMetadata* data) {
    const double centimetres = number(data, "UnitScaleFactor", 1);
    const double metres = std::isfinite(centimetres) && centimetres > 0 ? centimetres / 100 : 0.01;
    to_scene_ = glm::scale(glm::dmat4(1), glm::dvec3(metres));
    notes_.push_back(
        fmt::format("FBX: a unit of {:g} cm; positions times {:g}, so that they are metres", metres * 100, metres));
    glm::dmat3 turn(0);  // rows: the file's axis that points right, up, and to the front
    constexpr std::array<const char*, 3> kAxes = {"CoordAxis", "UpAxis", "FrontAxis"};
    for (int row = 0; row < 3; ++row) {
      const std::string axis = kAxes[static_cast<std::size_t>(row)];
      const double column = number(data, axis, row), sign = number(data, axis + "Sign", 1);
      if (column >= 0 && column < 3) turn[static_cast<int>(column)][row] = sign < 0 ? -1 : 1;
    }
    if (turn == glm::dmat3(1)) return;
    if (glm::determinant(turn) != 1) {
      notes_.emplace_back("FBX: its axes do not form a right-handed frame, so they are not changed");
      return;
    }
    to_scene_ = to_scene_ * glm::dmat4(turn);
    notes_.emplace_back("FBX: turned so that the axis that the file calls up is Y");
  }
  [[nodiscard]] const glm::dmat4& to_scene() const { return to_scene_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  static double number(const aiMetadata* data, const std::string& name, double fallback) {
    if (data == nullptr) return fallback;
    double real = 0;
    float single = 0;
    std::int32_t whole = 0;
    if (data->Get(name, real)) return real;
    if (data->Get(name, single)) return static_cast<double>(single);
    return data->Get(name, whole) ? whole : fallback;
  }

  glm::dmat4 to_scene_{1};
  std::vector<std::string> notes_;
};

}  // namespace

mesh::ImportedMesh read_assimp_scene(const aiScene& scene, const std::string& file, const AssimpSceneOptions& options) {
  if (!options.is_fbx) return SceneReader(scene, file, glm::dmat4(1), options).read();
  const FbxFrame frame(scene.mMetaData);
  mesh::ImportedMesh mesh = SceneReader(scene, file, frame.to_scene(), options).read();
  mesh.notes.insert(mesh.notes.end(), frame.notes().begin(), frame.notes().end());
  return mesh;
}

}  // namespace penumbra::import
