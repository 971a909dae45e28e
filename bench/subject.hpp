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

/// What is looked at: a scene or a generated shape, perhaps with its first light made larger or smaller.
struct Subject {
  std::string name;  ///< stable: the scene's file name without extension, "knot-N" or "sphere-N", then "/half=H",
                     ///< "/light=KIND", "/pattern=P" and "/size=S" where they were asked for
  std::filesystem::path scene;         ///< empty: a knot or a sphere
  std::uint64_t knot = 0, sphere = 0;  ///< its triangles; 0: the other one
  std::optional<double> light_half;    ///< half size of the first light instead of the scene's
  /// What the first light, a rectangle, is turned into: as large, around the same centre.
  std::optional<visibility::LightKind> light_kind;
  visibility::SamplePattern pattern = visibility::SamplePattern::rows;
  std::uint32_t size = 512;  ///< pixels on a side
};

/// As the user gave them: texts become parts of stable names.
struct SubjectRequest {
  std::vector<std::string> scenes;    ///< names, files, "knot:N"; none: the shipped ones
  std::vector<std::string> halves;    ///< none: the scenes' own, and of the shipped bunny 0.3 and 2, too
  std::vector<std::string> lights;    ///< kinds; none: the scenes' own
  std::vector<std::string> patterns;  ///< none: rows
  std::vector<std::uint32_t> sizes;   ///< none: 512
  bool all = false;                   ///< the large shipped one, too
};
/// Throws UsageError.
std::vector<Subject> make_subjects(const SubjectRequest& request);

/// Reads or makes the scene, and gives its first light the half size and the kind. Throws UsageError or InputError.
scenes::Scene read_subject(const Subject& subject);

/// A torus knot, closed and shadowing itself, of exactly so many triangles. Throws UsageError where there is none: a
/// knot has 2 · segments · sides.
mesh::KnotShape knot_of(std::uint64_t triangles);

/// Latitudes and longitudes, about twice as many of these: exactly so many triangles. Throws UsageError where there is
/// none: a sphere has 2 · segments · (rings − 1).
mesh::SphereShape sphere_of(std::uint64_t triangles);

/// That sphere likewise.
scenes::Scene sphere_scene(std::uint64_t triangles);

/// That knot above a floor under a square light, seen by a camera like that of the default scene.
scenes::Scene knot_scene(std::uint64_t triangles);

}  // namespace penumbra::bench
