#pragma once

#include "scenes/scene.hpp"
#include "mesh/import.hpp"
#include "scenes/studio.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::scenes {

/// The size of lamps that a glTF file gives none and the user neither: a light bulb's and the sun's, in the scene's
/// unit and degrees.
inline constexpr double kLampRadius = 0.1, kSunAngle = 0.53;

/// Coordinates in a lightmap, for bakes: (0, 0) is its top left, (1, 1) its bottom right.
struct LightmapPlaces {
  std::uint32_t set = 0;           ///< glTF: which TEXCOORD_N is read; elsewhere there is one
  std::vector<glm::dvec2> places;  ///< of each position of the soup; kNoPlace: it has none
};
using mesh::kNoPlace;

struct ReadOptions {
  bool allow_outside = false;  ///< may the scene name files outside its folder?
  bool needs_light = true;     ///< has a scene without a light a studio put around it (JSON: is it an error)?
  std::optional<double> lamp_radius = {};  ///< glTF: of point and spot lamps whose file says none; above 0
  std::optional<double> sun_angle = {};    ///< glTF: of sun lamps whose file says none, degrees; 0 ≤ angle < 180
  /// glTF: by what lamps' intensities are divided; above 0. Nothing: 683 in files of Blender's exporter (before 3.4.36:
  /// 4π, of suns 1), else 1.
  std::optional<double> lumens_per_watt = {};
  bool lenient = false;             ///< glTF: leave out what cannot be done and would change shadows, with a warning
  std::optional<double> time = {};  ///< glTF: when, in seconds, its animations are looked at; nothing: at rest
  /// glTF: the animations that are played, by name or number from 0; empty: all that can be played at once.
  std::vector<std::string> clips = {};
  StudioWish studio = {};  ///< of scenes that need a light
  /// Gets the coordinates that glTF files, OBJ files and quads of JSON have in a lightmap; none: they are not read.
  LightmapPlaces* lightmap = nullptr;
};

/// Reads .json (penumbra-scene/1), .gltf or .glb by the file's extension; any other file as a mesh. Where a mesh or a
/// glTF scene has no light (and `needs_light` is on), a studio is put around it, with a warning. What comes back is
/// complete: at least one object, light (unless `needs_light` is off) and camera, every number finite, every index in
/// range. Otherwise InputError: the file, the place in it (JSON pointer or line), what is there and what would be
/// right.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace penumbra::scenes
