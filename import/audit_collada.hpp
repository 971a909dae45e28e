#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra::mesh {

/// The triangles that the polygons of a COLLADA file's scene are made of, each as often as the scene shows it: what
/// Assimp has to deliver. Throws InputError for what Assimp drops without a word: polygons with holes, and geometry
/// that another file holds.
std::uint64_t triangles_of_collada(std::string_view content, const std::string& file);

/// The same file without blanks before an element's first number: Assimp 5.2 refuses some, and takes them for a 0 in
/// others.
std::string without_leading_blanks(std::string_view content, const std::string& file);

}  // namespace penumbra::mesh
