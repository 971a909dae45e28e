// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "library/scene_state.hpp"
#include "mesh/triangle_soup.hpp"

#include <penumbra/scene.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace penumbra {

/// Throws InputError for a position that is not finite or too large; `where` begins the message.
void require_coordinates(std::span<const Vector> positions, const std::string& where);

/// Returns the arrays of a program as a soup of one object, number 0. Throws InputError for arrays rejected by
/// Scene::add_mesh().
mesh::TriangleSoup soup_of(std::span<const Vector> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                           const std::string& where);

/// Mesh as given by a program, without the vertices that no triangle uses.
struct GivenMesh {
  mesh::TriangleSoup soup;
  GivenVertices vertices;
  std::string warning;  ///< empty: all vertices are used
};

/// Throws as soup_of().
GivenMesh given_mesh(const std::string& where, std::span<const Vector> positions,
                     std::span<const std::array<std::uint32_t, 3>> triangles);

/// Records the indices of a mesh's given vertices that the scene keeps.
void note_given(Scene::State& state, std::uint32_t object, GivenVertices vertices);

}  // namespace penumbra
