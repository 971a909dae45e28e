// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace penumbra
