// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra::import {

/// Returns the number of triangles of all polygons in a COLLADA file's scene, each as often as the scene shows it: the
/// number that Assimp has to deliver. Throws InputError for content that Assimp drops silently: polygons with holes,
/// and geometry in another file.
std::uint64_t triangles_of_collada(std::string_view content, const std::string& file);

/// Returns the file without blanks before an element's first number: Assimp 5.2 refuses such blanks in some elements,
/// and reads them as a 0 in others.
std::string without_leading_blanks(std::string_view content, const std::string& file);

/// Returns the same file with a name for each camera that has none: Assimp 5.2 reads no lens of nameless cameras.
std::string with_named_cameras(std::string content);

/// Name of the material that with_plain_material() adds. Sorts before all names that XML permits.
inline constexpr std::string_view kPlainMaterial = "!penumbra-plain";

/// Returns the same file with one more material, kPlainMaterial, which Assimp then gives to meshes without a material:
/// it gives them the first material in alphabetical order, and any other one may emit light.
std::string with_plain_material(std::string content);

}  // namespace penumbra::import
