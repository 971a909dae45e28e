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

namespace penumbra::app {

/// A wedge that contains p, and what its edge does there.
struct ExplainedWedge {
  std::uint32_t wedge = 0;        ///< in the list of all
  std::int32_t multiplicity = 0;  ///< k_e from the light's centre, of what counts; 0: no silhouette from there
  double area = 0;                ///< added to the hidden share; 0 where the edge does not appear on the light
  glm::dvec3 a{0}, b{0};          ///< relative to the scene's origin
  std::optional<volumes::ClippedEdge> seen;  ///< on the light, in frame coordinates
};

struct Explanation {
  std::uint32_t x = 0, y = 0;
  visibility::PixelClass kind = visibility::PixelClass::background;
  std::string object;  ///< that carries p
  volumes::LitPoint sample;
  double given = 1;  ///< V where nothing is to be summed: of background, its body, what receives no shadow; behind
  std::vector<ExplainedWedge> wedges;
  std::vector<std::uint32_t> outside;  ///< edges that appear on the light, yet p is in none of their wedges: a flaw
  std::optional<volumes::LayerSum> center, receiver;  ///< nothing where V is `given`
  double exact = 0;                                   ///< V
  bool touching = false;                              ///< something meets the light itself: no sum is exact
  glm::uvec2 texels{0};  ///< of the light's texture, by which areas and V are weighed; 0: there is none
  std::string picture;   ///< SVG, where there is something to see
};

struct ToExplain {
  const scenes::Scene& scene;
  const visibility::SceneFloats& floats;
  const visibility::Light& light;
  const volumes::Casters& casters;
  const volumes::CastingEdges& casting;
  std::span<const volumes::Wedge> wedges;
};

/// "X,Y" as a pixel of the scene's image; throws UsageError if it is not.
std::pair<std::uint32_t, std::uint32_t> parse_pixel(const std::string& text, const scenes::Scene& scene);

/// Of the scene's first camera. A sphere light is the disk that p sees.
Explanation explain(const ToExplain& input, std::uint32_t x, std::uint32_t y);

nlohmann::ordered_json explain_json(const Explanation& explanation, const std::filesystem::path& svg);
void print_explanation(const Explanation& explanation, const std::filesystem::path& svg);

}  // namespace penumbra::app
