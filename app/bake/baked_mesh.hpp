#pragma once

#include "app/pictures/frame_render.hpp"
#include "scenes/formats/reader.hpp"
#include "scenes/scene.hpp"
#include "visibility/lightmap.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::app {

/// The part of a scene that is baked.
struct BakedMesh {
  std::vector<std::uint32_t> objects;    ///< all that have the name
  std::vector<std::uint32_t> triangles;  ///< numbers of their triangles, ascending
};

/// The objects of this name. Throws UsageError that says which there are.
BakedMesh find_baked(const scenes::Scene& scene, const std::string& name);

/// Makes every surface white, so that its beauty is the irradiance over π; what lets light through stays so. The camera
/// becomes one that sees all of the mesh: methods that fit their maps to what is seen fit them to the mesh.
void prepare_scene(scenes::Scene& scene, const BakedMesh& mesh);

/// The texels of the mesh's lightmap. Throws InputError if it has none, or if no texel lies on it. Overlaps, triangles
/// that leave the map and triangles without coordinates go to `notes`.
std::vector<visibility::SurfacePoint> lightmap_points(const scenes::Scene& scene, const BakedMesh& mesh,
                                                      const scenes::LightmapPlaces& lightmap, std::uint32_t width,
                                                      std::uint32_t height, std::vector<std::string>& notes);

/// The vertices of the mesh, and the points that their values are means of: one in each triangle at the vertex, a 256th
/// of the way from it to the middle of the triangle, so that a wall that meets the vertex shades it.
struct VertexPoints {
  std::vector<std::uint32_t> vertices;           ///< numbers of the soup's positions, in order of first use
  std::vector<mesh::Triangle> triangles;         ///< of these vertices
  std::vector<visibility::SurfacePoint> points;  ///< three a triangle, then no points up to a full row
  std::vector<double> weights;                   ///< of the first of these: the triangle's angle at the vertex
};
/// `width`: points in a row.
VertexPoints vertex_points(const scenes::Scene& scene, const BakedMesh& mesh, std::uint32_t width);

/// Beauty of white surfaces becomes irradiance; a light's own body gets none from it.
void make_irradiance(RenderedFrame& frame, const Session& session);

/// Texels around those of the mesh get the values of the nearest (margin_sources), alpha stays 0 there. What is not
/// covered, and no margin, is 0.
void fill_margins(RenderedFrame& frame, std::span<const std::int64_t> sources);

}  // namespace penumbra::app
