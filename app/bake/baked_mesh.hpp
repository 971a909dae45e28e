// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"
#include "session/pictures/frame_render.hpp"
#include "visibility/lightmap.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::app {

/// Baked part of a scene.
struct BakedMesh {
  std::vector<std::uint32_t> objects;    ///< all objects with the name
  std::vector<std::uint32_t> triangles;  ///< indices of their triangles, ascending
};

/// Returns the objects with this name. Throws UsageError, with the list of existing names, if there are none.
BakedMesh find_baked(const scenes::Scene& scene, const std::string& name);

/// Makes every surface white, so that its beauty is the irradiance divided by π; transparency is unchanged. The
/// camera is replaced by one that sees all of the mesh: methods that fit their maps to the view thus fit them to the
/// mesh.
void prepare_scene(scenes::Scene& scene, const BakedMesh& mesh);

/// Returns the texels of the mesh's lightmap. Throws InputError if there is none, or if no texel lies on the mesh.
/// Overlaps, triangles outside the map and triangles without coordinates are listed in `notes`.
std::vector<visibility::SurfacePoint> lightmap_points(const scenes::Scene& scene, const BakedMesh& mesh,
                                                      const scenes::LightmapPlaces& lightmap, std::uint32_t width,
                                                      std::uint32_t height, std::vector<std::string>& notes);

/// Vertices of the mesh, and the points whose mean is a vertex's value: one in each triangle at the vertex, a 256th of
/// the distance from the vertex to the middle of the triangle, so that a wall that meets the vertex shades the point.
struct VertexPoints {
  std::vector<std::uint32_t> vertices;           ///< indices of the soup's positions, in order of first use
  std::vector<mesh::Triangle> triangles;         ///< indices into `vertices`
  std::vector<visibility::SurfacePoint> points;  ///< three for each triangle, padded with empty points to a full row
  std::vector<double> weights;                   ///< the triangle's angle at the vertex, for all points but the padding
};
/// Returns the vertices and their points. `width`: points in a row.
VertexPoints vertex_points(const scenes::Scene& scene, const BakedMesh& mesh, std::uint32_t width);

/// Converts the beauty of white surfaces to irradiance; a light's own body receives none from that light.
void make_irradiance(session::RenderedFrame& frame, const session::Session& session);

/// Fills texels around those of the mesh with the values of the nearest mesh texels (margin_sources); alpha stays 0
/// there. Texels neither covered nor in the margin are 0.
void fill_margins(session::RenderedFrame& frame, std::span<const std::int64_t> sources);

}  // namespace penumbra::app
