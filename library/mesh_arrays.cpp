// SPDX-License-Identifier: Apache-2.0
// Checks a program's mesh arrays and converts them to a soup.

#include "library/mesh_arrays.hpp"

#include "base/error.hpp"
#include "library/float3.hpp"
#include "library/light_shape.hpp"
#include "mesh/unused_vertices.hpp"
#include "scenes/formats/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace penumbra {

void require_coordinates(std::span<const Vector> positions, const std::string& where) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto is_coordinate = [](double x) { return std::abs(x) <= scenes::kLargestCoordinate; };  // false for NaN
    if (!std::ranges::all_of(positions[i], is_coordinate)) {
      throw InputError("{}: vertex {} is ({}, {}, {}); expected finite numbers up to {}", where, i, positions[i][0],
                       positions[i][1], positions[i][2], scenes::kLargestCoordinate);
    }
  }
}

mesh::TriangleSoup soup_of(std::span<const Vector> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                           const std::string& where) {
  if (triangles.empty()) throw InputError("{}: it has no triangles", where);
  if (std::max(positions.size(), triangles.size()) > std::numeric_limits<std::uint32_t>::max())
    throw InputError("{}: it has more than 2^32 vertices or triangles", where);
  require_coordinates(positions, where);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t largest = std::ranges::max(triangles[i]);
    if (largest >= positions.size())
      throw InputError("{}: triangle {} has vertex {}; there are {}", where, i, largest, positions.size());
  }
  mesh::TriangleSoup soup;
  soup.positions.reserve(positions.size());
  for (const Vector& p : positions) soup.positions.push_back(to_glm(p));
  soup.triangles.assign(triangles.begin(), triangles.end());
  soup.object.assign(triangles.size(), 0);
  soup.source_face.resize(triangles.size());
  std::iota(soup.source_face.begin(), soup.source_face.end(), std::uint32_t{0});
  return soup;
}

GivenMesh given_mesh(const std::string& where, std::span<const Vector> positions,
                     std::span<const std::array<std::uint32_t, 3>> triangles) {
  GivenMesh given{.soup = soup_of(positions, triangles, where), .vertices = {}, .warning = {}};
  given.vertices.used = mesh::drop_unused_vertices(given.soup);
  given.vertices.count = positions.size();
  if (const std::size_t unused = positions.size() - given.soup.positions.size(); unused > 0)
    given.warning = fmt::format("{}: left out {} vertices that no triangle uses", where, unused);
  return given;
}

void note_given(Scene::State& state, std::uint32_t object, GivenVertices vertices) {
  if (vertices.used.empty() && object >= state.given.size()) return;
  if (object >= state.given.size()) state.given.resize(object + 1);
  state.given[object] = std::move(vertices);
}

}  // namespace penumbra
