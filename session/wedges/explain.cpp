// SPDX-License-Identifier: Apache-2.0
// Explains one pixel: its wedges, edges and sums.

#include "session/wedges/explain.hpp"

#include "areas/exact_area.hpp"
#include "base/error.hpp"
#include "session/parse.hpp"
#include "session/pixel_samples.hpp"
#include "session/wedges/light_picture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>

namespace penumbra::session {
namespace {

using nlohmann::ordered_json;
using visibility::PixelClass;
using volumes::LayerSum;

const char* name_of(PixelClass kind) {
  static constexpr std::array kNames = {"background", "emitter", "unshadowed", "judged",
                                        "horizon",    "behind",  "unlit",      "other body"};
  return kNames[static_cast<std::size_t>(kind)];
}

double exact_visibility(const ToExplain& input, const volumes::LitPoint& sample) {
  areas::ExactArea area(input.floats);
  area.set_light(input.light);
  return area.visibility({sample.p, sample.carrier, sample.facing});
}

/// Adds each edge once, with its first wedge that contains p; and the visible edges without such a wedge.
void explain_wedges(const ToExplain& input, const volumes::SoftVisibility& soft, Explanation& result) {
  std::map<std::uint32_t, std::int32_t> multiplicity;
  for (const auto& [edge, k] : soft.silhouettes(result.sample, volumes::Viewer::center)) multiplicity[edge] = k;
  std::map<std::uint32_t, const volumes::CoveredEdge*> unexplained;
  for (const volumes::CoveredEdge& covered : result.center->edges) unexplained[covered.edge] = &covered;
  std::optional<std::uint32_t> last;
  for (std::uint32_t i = 0; i < input.wedges.size(); ++i) {
    const volumes::Wedge& wedge = input.wedges[i];
    if (wedge.outcome == volumes::WedgeOutcome::split || wedge.outcome == volumes::WedgeOutcome::empty) continue;
    if (last == wedge.source || !volumes::is_inside(wedge, glm::dvec3(result.sample.p))) continue;
    last = wedge.source;
    const std::uint32_t edge = input.casting.edges[wedge.source];
    const volumes::WedgeEdge& whole = input.casting.wedges[wedge.source];
    ExplainedWedge& entry = result.wedges.emplace_back();
    entry = {i, multiplicity.contains(edge) ? multiplicity[edge] : 0, 0, whole.a, whole.b, {}};
    const auto found = unexplained.find(edge);
    if (found == unexplained.end()) continue;
    entry.area = found->second->area;
    entry.seen = found->second->clipped;
    unexplained.erase(found);
  }
  // Some edges become silhouettes only because p's own triangle, and the triangles in its plane, are left out; they are
  // not silhouettes of the mesh, and have no wedges.
  const std::vector<volumes::SoftVisibility::Silhouette>& built = soft.silhouettes_of_center();  // by index
  for (const auto& [edge, covered] : unexplained) {
    if (std::ranges::binary_search(built, edge, {}, &volumes::SoftVisibility::Silhouette::first))
      result.outside.push_back(edge);
  }
}

std::string title_of(const ToExplain& input, const Explanation& explanation) {
  return fmt::format("{}: light {} as seen from pixel {},{} ({})", input.scene.name, input.light.name, explanation.x,
                     explanation.y, explanation.object);
}

std::string text_of(const glm::dvec3& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

ordered_json array_of(const glm::dvec2& v) {
  return {v.x, v.y};
}

ordered_json array_of(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

ordered_json sum_json(const LayerSum& sum) {
  ordered_json entry{{"reference", array_of(sum.reference_at)},
                     {"referenceMoved", sum.moved},
                     {"constant", sum.constant},
                     {"edges", sum.edges.size()},
                     {"sum", sum.sum},
                     {"blocked", sum.blocked},
                     {"above", sum.above},
                     {"V", sum.visibility}};
  return entry;
}

void print_sum(const char* what, const LayerSum& sum) {
  fmt::print(
      "{:<24} {:>3} layers at {} + {:.9f} of {} edges = {:.9f}; V = {:.9f}\n", what, sum.constant,
      sum.moved ? fmt::format("({:.4f}, {:.4f})", sum.reference_at.x, sum.reference_at.y) : std::string("the centre"),
      sum.sum, sum.edges.size(), sum.blocked, sum.visibility);
}

}  // namespace

std::pair<std::uint32_t, std::uint32_t> parse_pixel(const std::string& text, const scenes::Scene& scene) {
  const auto parts = split(text, ',');
  const auto x = parts.size() == 2 ? parse_integer<std::uint32_t>(parts[0]) : std::nullopt;
  const auto y = parts.size() == 2 ? parse_integer<std::uint32_t>(parts[1]) : std::nullopt;
  if (!x || !y) throw UsageError("--explain {}: expected X,Y, such as 200,300", text);
  if (*x >= scene.width || *y >= scene.height) {
    throw UsageError("--explain {}: outside the image of {}x{}", text, scene.width, scene.height);
  }
  return {*x, *y};
}

Explanation explain(const ToExplain& input, std::uint32_t x, std::uint32_t y) {
  const visibility::PinholeCamera camera =
      visibility::make_camera(input.scene.cameras.front(), input.floats.origin, input.scene.width, input.scene.height);
  const std::uint32_t pixel = y * input.scene.width + x;
  const visibility::ViewSamples samples = samples_at(input.floats, camera, std::array{pixel});
  Explanation result;
  result.x = x;
  result.y = y;
  result.kind = visibility::classify_pixels(input.floats, samples, input.light)[pixel];
  if (result.kind == PixelClass::background) return result;
  result.sample = {samples.p[pixel], static_cast<std::uint32_t>(samples.triangle[pixel]), samples.facing[pixel]};
  result.object = input.scene.objects[input.floats.object[result.sample.carrier]].name;
  result.given = result.kind == PixelClass::behind || result.kind == PixelClass::unlit ? 0 : 1;
  const bool asked =
      result.kind == PixelClass::judged || result.kind == PixelClass::horizon || result.kind == PixelClass::other_body;
  if (!asked) return result;
  const volumes::SoftVisibility soft(input.floats, input.light, input.casters);
  result.center = soft.at(result.sample, volumes::Viewer::center);
  result.receiver = soft.at(result.sample, volumes::Viewer::receiver);
  result.exact = exact_visibility(input, result.sample);
  result.touching = soft.something_touches_light();
  if (input.light.texture) result.texels = {input.light.texture->width, input.light.texture->height};
  explain_wedges(input, soft, result);
  result.picture = svg_of({input.light, input.casters, soft, result.sample, *result.center, *result.receiver,
                           result.exact, title_of(input, result)});
  return result;
}

ordered_json explain_json(const Explanation& explanation, const std::filesystem::path& svg) {
  ordered_json entry{{"pixel", {explanation.x, explanation.y}}, {"class", name_of(explanation.kind)}};
  if (explanation.kind != PixelClass::background) {
    entry["object"] = explanation.object;
    entry["triangle"] = explanation.sample.carrier;
    entry["p"] = array_of(glm::dvec3(explanation.sample.p));
  }
  if (!explanation.center) {
    entry["V"] = explanation.given;
    return entry;
  }
  entry["texture"] =
      explanation.texels.x > 0 ? ordered_json{explanation.texels.x, explanation.texels.y} : ordered_json();
  entry["wedges"] = ordered_json::array();
  for (const ExplainedWedge& wedge : explanation.wedges) {
    ordered_json one{{"wedge", wedge.wedge}, {"multiplicity", wedge.multiplicity}, {"area", wedge.area}};
    one["seen"] = wedge.seen ? ordered_json{array_of(wedge.seen->from), array_of(wedge.seen->to)} : ordered_json();
    entry["wedges"].push_back(one);
  }
  entry["touchingLight"] = explanation.touching;
  entry["edgesOutsideTheirWedges"] = explanation.outside.size();
  entry["centre"] = sum_json(*explanation.center);
  entry["receiver"] = sum_json(*explanation.receiver);
  entry["exactV"] = explanation.exact;
  entry["svg"] = svg.empty() ? ordered_json() : ordered_json(svg.string());
  return entry;
}

void print_explanation(const Explanation& explanation, const std::filesystem::path& svg) {
  fmt::print("pixel {},{}: ", explanation.x, explanation.y);
  switch (explanation.kind) {
    case PixelClass::background:
      fmt::print("background, no surface; V = 1\n");
      return;
    case PixelClass::emitter:
      fmt::print("{} is the body of this light; V = 1\n", explanation.object);
      return;
    case PixelClass::unshadowed:
      fmt::print("{} receives no shadow; V = 1\n", explanation.object);
      return;
    case PixelClass::behind:
      fmt::print("{} at {} is behind the light; V = 0\n", explanation.object,
                 text_of(glm::dvec3(explanation.sample.p)));
      return;
    case PixelClass::unlit:
      fmt::print("{} is not lit by this light; V = 0\n", explanation.object);
      return;
    case PixelClass::judged:
    case PixelClass::horizon:
    case PixelClass::other_body:
      break;
  }
  fmt::print("{}, triangle {}, p = {}\n", explanation.object, explanation.sample.carrier,
             text_of(glm::dvec3(explanation.sample.p)));
  if (explanation.kind == PixelClass::horizon) {
    fmt::print("{:.6f} of the light is above the tangent plane: V cannot be larger\n", explanation.center->above);
  }
  if (explanation.texels.x > 0) {
    fmt::print("areas and V are weighted by the light's texture of {}x{} texels\n", explanation.texels.x,
               explanation.texels.y);
  }
  if (explanation.touching) fmt::print("something touches the light itself: no sum over edges is exact\n");
  fmt::print("in {} wedges:\n", explanation.wedges.size());
  for (const ExplainedWedge& wedge : explanation.wedges) {
    fmt::print("  wedge {:>6}  {} to {}  k {:+d}  area {:+.9f}{}\n", wedge.wedge, text_of(wedge.a), text_of(wedge.b),
               wedge.multiplicity, wedge.area, wedge.seen ? "" : "  (not on the light)");
  }
  for (const std::uint32_t edge : explanation.outside) {
    fmt::print("  edge {} appears on the light, but p is in none of its wedges\n", edge);
  }
  print_sum("silhouettes of centre:", *explanation.center);
  print_sum("silhouettes of p:", *explanation.receiver);
  fmt::print("exact area: V = {:.9f}\n", explanation.exact);
  if (!svg.empty()) fmt::print("picture: {}\n", svg.string());
}

}  // namespace penumbra::session
