// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/shapes/shapes.hpp"
#include "scenes/scene.hpp"
#include "visibility/light_samples.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::bench {

/// Scene or generated shape, possibly with a resized first light.
struct Subject {
  std::string name;  ///< stable: the scene's file name without extension, "knot-N" or "sphere-N", then "/half=H",
                     ///< "/light=KIND", "/pattern=P" and "/size=S" where given
  std::filesystem::path scene;         ///< empty: a knot or a sphere
  std::uint64_t knot = 0, sphere = 0;  ///< number of triangles; 0: the other shape
  std::optional<double> light_half;    ///< half size of the first light; nullopt: the scene's own
  /// Kind to which the first light, a rectangle, is converted: of the same size, around the same centre.
  std::optional<visibility::LightKind> light_kind;
  visibility::SamplePattern pattern = visibility::SamplePattern::rows;
  std::uint32_t size = 512;  ///< pixels on a side
};

/// Subjects as given on the command line: texts become parts of stable names.
struct SubjectRequest {
  std::vector<std::string> scenes;    ///< names, files, "knot:N"; empty: the shipped scenes
  std::vector<std::string> halves;    ///< empty: the scenes' own, and for the shipped bunny also 0.3 and 2
  std::vector<std::string> lights;    ///< kinds; empty: the scenes' own
  std::vector<std::string> patterns;  ///< empty: rows
  std::vector<std::uint32_t> sizes;   ///< empty: 512
  bool all = false;                   ///< adds the large shipped scene
};
/// Makes all combinations. Throws UsageError for an unknown name or value.
std::vector<Subject> make_subjects(const SubjectRequest& request);

/// Reads or makes the scene, and sets the half size and the kind of its first light. Throws UsageError or InputError.
scenes::Scene read_subject(const Subject& subject);

/// Returns a torus knot, closed and shadowing itself, of exactly `triangles` triangles. Throws UsageError if there is
/// none: a knot has 2 · segments · sides triangles.
mesh::KnotShape knot_of(std::uint64_t triangles);

/// Returns a sphere of latitudes and about twice as many longitudes, of exactly `triangles` triangles. Throws
/// UsageError if there is none: a sphere has 2 · segments · (rings − 1) triangles.
mesh::SphereShape sphere_of(std::uint64_t triangles);

/// Returns the scene of sphere_of(triangles), arranged like knot_scene().
scenes::Scene sphere_scene(std::uint64_t triangles);

/// Returns the scene of knot_of(triangles) above a floor under a square light, seen by a camera like that of the
/// default scene.
scenes::Scene knot_scene(std::uint64_t triangles);

}  // namespace penumbra::bench
