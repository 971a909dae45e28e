// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace penumbra::scenes {

/// Reads a glTF 2.0 scene (.gltf or .glb) as Blender's exporter writes it, in the import helper's process and under its
/// limits, like every foreign file.
///
/// - The default scene's node tree; a node's mesh becomes one object for each primitive, named after the node.
/// - Skins and morph targets; animations of nodes (including cameras and lamps) and weights, at `options.time`.
/// - Perspective and orthographic cameras; without one, a camera that sees everything, and a warning.
/// - Base colour factors and pictures, and vertex colours.
/// - A primitive with an emissive material is an area light (import/gltf/emitters/emitter.hpp: a rectangle, a polygon,
///   a sphere or pieces) with radiance emissiveFactor × KHR_materials_emissive_strength. It emits to the side from
///   which its triangles run counter-clockwise, to both if the material is double-sided. It stays an object, with
///   `emits` set.
///
/// Throws InputError, with a place such as "/accessors/3", for violations of glTF 2.0 that matter here, for a scene
/// without an area light if `options.needs_light`, and for a buffer outside the file's folder unless
/// `options.allow_outside`.
///
/// Also reads FBX and COLLADA files (.fbx, .dae), as import/foreign_scene.hpp describes.
Scene read_gltf(const std::filesystem::path& file, const ReadOptions& options = {});
/// Reads a .glb file whose bytes are in memory. `name`: its name in messages. `folder`: folder of the files that
/// `bytes` names; empty: there are no such files.
Scene read_glb(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options = {},
               const std::filesystem::path& folder = {});

}  // namespace penumbra::scenes
