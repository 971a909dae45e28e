// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/triangle_soup.hpp"
#include "session/inspect/scene_facts.hpp"
#include "session/process/progress.hpp"
#include "visibility/light_samples.hpp"
#include "visibility/mesh_verdict.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::session {

/// Mesh file or scene, as input of `inspect`.
struct InspectedMesh {
  mesh::TriangleSoup soup;                     ///< world space
  std::vector<std::string> objects;            ///< names, by TriangleSoup::object
  std::vector<std::string> notes;              ///< parts skipped or changed on reading
  std::vector<std::filesystem::path> sources;  ///< this file and the files named in it: never to be overwritten
  struct Light {
    std::string name;
    visibility::LightKind kind;
  };
  std::vector<Light> lights;             ///< of a scene
  std::optional<SceneFacts> scene = {};  ///< nullopt: a mesh file
};

/// Reads .json, .gltf and .glb as scenes (glTF: with or without a light), any other file as a mesh. Throws InputError.
/// `step`: scenes::ReadOptions::step.
InspectedMesh read_inspected(const std::filesystem::path& file, bool allow_outside,
                             const std::function<void()>* step = nullptr);

/// Objects of a soup, each as a separate soup. Refers to the whole soup.
class ObjectParts {
 public:
  ObjectParts(const mesh::TriangleSoup& soup, std::size_t objects);

  /// Returns the indices of an object's triangles in the whole soup.
  [[nodiscard]] const std::vector<std::uint32_t>& triangles_of(std::size_t object) const { return triangles_[object]; }
  /// Returns one object's triangles, with only the positions used by them.
  mesh::TriangleSoup soup_of(std::size_t object);

 private:
  const mesh::TriangleSoup& soup_;
  std::vector<std::vector<std::uint32_t>> triangles_;
  std::vector<std::uint32_t> new_index_;
};

/// Returns a soup as a scene of one object, without light and camera.
scenes::Scene scene_of(const mesh::TriangleSoup& soup, const std::string& name);

/// Number of silhouette edges seen from the eight points that lie one diagonal of the bounds from their centre toward
/// the corners of a cube. The literature's rule of thumb for closed meshes is n^0.8 of n triangles.
struct SilhouetteCounts {
  double mean = 0;
  std::uint64_t most = 0;
};

/// Verdict of a method on an object.
struct MethodVerdict {
  std::string method;
  visibility::MeshVerdict verdict;
};

struct ObjectReport {
  std::string name;
  mesh::Diagnosis diagnosis;
  std::optional<SilhouetteCounts> silhouettes;  ///< nullopt if such points are beyond double's range
  std::vector<std::uint32_t> triangles;         ///< for each of the diagnosis' triangles, its index in the file; empty:
                                                ///< the same
  std::vector<MethodVerdict> verdicts;
};

struct FileReport {
  std::filesystem::path file;
  std::string error;  ///< reason why the file could not be read; the other members are then empty
  std::vector<std::string> notes;
  std::optional<SceneFacts> scene = {};    ///< nullopt: a mesh file
  std::vector<std::uint32_t> source_face;  ///< for each triangle, the face's index in its file
  std::vector<ObjectReport> objects;
  ObjectReport total;  ///< of all triangles together, as one soup
};

/// Diagnoses each object, and all together. `options.progress` is not used: progress goes to `progress`.
FileReport examine(const std::filesystem::path& file, const InspectedMesh& mesh, const mesh::DiagnosisOptions& options,
                   Progress& progress);

}  // namespace penumbra::session
