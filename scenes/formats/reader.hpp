// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"
#include "mesh/triangle_soup.hpp"
#include "scenes/scene.hpp"
#include "scenes/studio.hpp"

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::scenes {

/// Default sizes of lamps in glTF files that specify none: those of a light bulb and the sun, in the scene's unit and
/// in degrees.
inline constexpr double kLampRadius = 0.1, kSunAngle = 0.53;

/// Lightmap coordinates, for baking: (0, 0) is the lightmap's top left, (1, 1) its bottom right.
struct LightmapPlaces {
  std::uint32_t set = 0;           ///< glTF: the N of the TEXCOORD_N to read; other formats have one set
  std::vector<glm::dvec2> places;  ///< for each position of the soup; kNoPlace: it has none
};
using mesh::kNoPlace;

struct Instances;
struct ScenesAhead;

struct ReadOptions {
  bool allow_outside = false;  ///< the scene may name files outside its folder
  bool needs_light = true;     ///< a scene without a light gets a studio (JSON: is an error)
  bool needs_surface = true;   ///< read_gltf: a file without triangles, such as one of lamps alone, is an error
  std::optional<double> lamp_radius = {};  ///< glTF: radius of point and spot lamps without one in the file; above 0
  std::optional<double> sun_angle = {};  ///< glTF: angle of sun lamps without one in the file, degrees; 0 ≤ angle < 180
  /// glTF: divisor of lamps' intensities; above 0. nullopt: 683 in files of Blender's exporter (before 3.4.36: 4π, for
  /// suns 1), else 1.
  std::optional<double> lumens_per_watt = {};
  bool lenient = false;             ///< glTF: leaves out unsupported features that would change shadows, with a warning
  std::optional<double> time = {};  ///< glTF: time of the animations, in seconds; nullopt: at rest
  /// glTF: the animations that are played, by name or index from 0; empty: all that can be played together.
  std::vector<std::string> clips = {};
  StudioWish studio = {};  ///< studio for scenes that need a light
  /// For a scene that is one file per frame: the first file. A studio is built around this file's scene, and its origin
  /// is used. Null: the scene itself, or the scene at rest.
  const Scene* rest = nullptr;
  /// Receives the lightmap coordinates of glTF files, OBJ files and quads of JSON; null: they are not read.
  LightmapPlaces* lightmap = nullptr;
  /// Receives meshes that the scene has several times (scenes/instances.hpp); null: they are copied into the scene's
  /// soup.
  Instances* instances = nullptr;
  /// Memory for each triangle that the caller needs afterwards, in addition to the scene: instances become copies only
  /// where this fits as well.
  std::uint64_t bytes_per_copy = 0;
  /// glTF with a `time`: other times at which the scene will be needed. Their scenes are read in advance while the file
  /// is parsed, and later taken from here. Not with `lightmap`. Null: none.
  ScenesAhead* ahead = nullptr;
  /// Called ten times a second while another process reads a file, and before each mesh of a JSON file; its exception
  /// ends the reading. Null: none.
  const std::function<void()>* step = nullptr;
  /// JSON: meshes of the calling program that replace the sources of entries of "meshes", by index; null: none.
  const std::map<std::size_t, mesh::TriangleSoup>* given = nullptr;
};

/// Reads .json (penumbra-scene/1), .gltf or .glb, .fbx or .dae by the file's extension; any other file as a mesh. If a
/// mesh or a glTF scene has no light (and `needs_light` is on), a studio is put around it, with a warning. The result
/// is complete: at least one object, light (unless `needs_light` is off) and camera, every number finite, every index
/// in range. Otherwise throws InputError with the file, the location in it (JSON pointer or line), the found value and
/// the expected one.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace penumbra::scenes
