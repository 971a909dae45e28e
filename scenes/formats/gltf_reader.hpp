// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace penumbra::scenes {

/// Reads a glTF 2.0 scene (.gltf or .glb) as Blender's exporter writes it; in the import helper's process and under its
/// limits, like every foreign file.
///
/// - The default scene's node tree; a node's mesh becomes one object for each primitive, named after the node.
/// - Skins and morph targets; animations of nodes (including cameras and lamps) and weights, at `options.time`.
/// - Perspective cameras; without one, a camera that sees everything, and a warning.
/// - Base colour factors; textures are counted in a warning.
/// - A primitive with an emissive material is an area light (import/gltf/emitters/emitter.hpp: a rectangle, a polygon,
///   a sphere or pieces) with radiance emissiveFactor × KHR_materials_emissive_strength. It emits to the side from
///   which its triangles run counter-clockwise, to both if the material is double-sided. It stays an object, with
///   `emits` set.
///
/// InputError, with a place such as "/accessors/3", for whatever glTF 2.0 forbids and matters here, for a scene
/// without an area light if `options.needs_light`, and for a buffer outside the file's folder unless
/// `options.allow_outside`.
///
/// FBX and COLLADA files (.fbx, .dae) likewise, with what import/foreign_scene.hpp says of them.
Scene read_gltf(const std::filesystem::path& file, const ReadOptions& options = {});
/// Reads a file's bytes (.glb) that lie in memory. `name`: in messages. `folder`: the files that `bytes` names lie
/// here; empty: there are none.
Scene read_glb(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options = {},
               const std::filesystem::path& folder = {});

}  // namespace penumbra::scenes
