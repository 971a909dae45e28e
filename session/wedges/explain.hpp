// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"
#include "visibility/view_samples.hpp"
#include "volumes/wedges/soft_visibility.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::session {

/// Wedge that contains p, and the effect of its edge there.
struct ExplainedWedge {
  std::uint32_t wedge = 0;        ///< index in the list of all wedges
  std::int32_t multiplicity = 0;  ///< k_e from the light's centre, of the counted triangles; 0: no silhouette from
                                  ///< there
  double area = 0;                ///< contribution to the hidden fraction; 0 if the edge does not appear on the light
  glm::dvec3 a{0}, b{0};          ///< relative to the scene's origin
  std::optional<volumes::ClippedEdge> seen;  ///< on the light, in frame coordinates
};

struct Explanation {
  std::uint32_t x = 0, y = 0;
  visibility::PixelClass kind = visibility::PixelClass::background;
  std::string object;  ///< carrier of p
  volumes::LitPoint sample;
  double given = 1;  ///< V without a sum: for background, the light's body, surfaces without shadow; behind the light
  std::vector<ExplainedWedge> wedges;
  std::vector<std::uint32_t> outside;  ///< edges that appear on the light although p is in none of their wedges: a
                                       ///< fault
  std::optional<volumes::LayerSum> center, receiver;  ///< nullopt where V is `given`
  double exact = 0;                                   ///< exact V
  bool touching = false;                              ///< a caster meets the light itself: no sum is exact
  glm::uvec2 texels{0};  ///< of the light's texture, which weights areas and V; 0: no texture
  std::string picture;   ///< SVG, if there is anything to draw
};

struct ToExplain {
  const scenes::Scene& scene;
  const visibility::SceneFloats& floats;
  const visibility::Light& light;
  const volumes::Casters& casters;
  const volumes::CastingEdges& casting;
  std::span<const volumes::Wedge> wedges;
};

/// Parses "X,Y" as a pixel of the scene's image; throws UsageError if invalid.
std::pair<std::uint32_t, std::uint32_t> parse_pixel(const std::string& text, const scenes::Scene& scene);

/// Explains a pixel of the scene's first camera. A sphere light is the disk visible from p.
Explanation explain(const ToExplain& input, std::uint32_t x, std::uint32_t y);

nlohmann::ordered_json explain_json(const Explanation& explanation, const std::filesystem::path& svg);
void print_explanation(const Explanation& explanation, const std::filesystem::path& svg);

}  // namespace penumbra::session
