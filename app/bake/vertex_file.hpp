// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/bake/baked_mesh.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::app {

/// V and irradiance of one light at each vertex.
struct VertexLight {
  std::string layer;  ///< the light's name as used for layers of pictures
  std::vector<float> visibility;
  std::vector<glm::vec3> irradiance;
};

/// Returns the means of the points' values at each vertex, weighted by the triangles' angles there.
std::vector<VertexLight> values_at_vertices(const VertexPoints& points, const session::RenderedFrame& frame,
                                            const session::Session& session);

/// Writes a binary PLY: x y z in double (world space), red green blue (uchar, sRGB: the irradiance of all lights,
/// scaled to be as bright as fits), V (the first light's), irradiance_r g b (of all lights), and <light>_V, _r, _g, _b
/// of each light, in float; then the triangles. The file appears whole or not at all.
void write_vertex_ply(const std::filesystem::path& file, const std::vector<glm::dvec3>& positions,
                      const VertexPoints& points, const std::vector<VertexLight>& lights);

}  // namespace penumbra::app
