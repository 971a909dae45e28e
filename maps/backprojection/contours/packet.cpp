// Yang, Feng, Guennebaud and Liu 2009, "Packet-based hierarchal soft shadow mapping": the contours of `contour`, found
// once for a packet of pixels and below the nodes of a multi-scale pyramid, and the light cut into sub-lights with a
// map each. Departures: those of contour; a texel parts a packet where it is near some pixel's plane in its own
// direction, not where its depth is between the pixels' (thresholds.glsl); a packet that is not coherent is done pixel
// by pixel by the same workgroup, not in a second pass; a textured light is as many plain ones as there are sub-lights.

#include "maps/backprojection/contours/packet.hpp"

#include "maps/backprojection/contours/contour_recipe.hpp"
#include "maps/backprojection/subsampled.hpp"

#include <utility>

namespace penumbra::maps {
namespace {

struct Extent {
  std::uint32_t width, height;
  constexpr bool operator==(const Extent&) const = default;
};
constexpr visibility::ChoiceOption kPacket{"packet",
                                           {{"1x1", Extent{1, 1}},
                                            {"2x1", Extent{2, 1}},
                                            {"2x2", Extent{2, 2}},
                                            {"3x2", Extent{3, 2}},
                                            {"3x3", Extent{3, 3}},
                                            {"4x2", Extent{4, 2}},
                                            {"4x4", Extent{4, 4}},
                                            {"5x5", Extent{5, 5}},
                                            {"8x4", Extent{8, 4}},
                                            {"8x8", Extent{8, 8}}},
                                           Extent{3, 3},
                                           "pixels that look for contours together"};
constexpr visibility::IntegerOption kSubLights{
    "sublights", 1, 16, 1, "parts of the light along each axis, each with a map of its own; V is their mean"};
constexpr auto kHierarchy =
    visibility::flag_option("hierarchy", true, "find contours below nodes of a multi-scale pyramid, not cell by cell");
constexpr visibility::RealOption kDivergence{
    "divergence", 0, 1, 0.8,
    "a packet whose pixels are more likely than this to have different contours is done pixel by pixel"};

}  // namespace

visibility::MethodDescription packet_description() {
  visibility::MethodDescription description{
      .name = "packet",
      .family = visibility::Family::image,
      .paper = "Yang et al. 2009",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps, where all that shades lies in one plane parallel to the light",
      .lights = planar_lights(),
      .options = single_map_option_descriptions(),
      .verdict_on = contour_verdict,
      .repairs = contour_repairs};
  description.options.push_back(kPacket.description());
  description.options.push_back(kSubLights.description());
  description.options.push_back(kHierarchy.description());
  description.options.push_back(kDivergence.description());
  description.options.push_back(kSubsample.description());
  description.options.push_back(kSubsampleBy.description());
  return description;
}

std::unique_ptr<visibility::Method> make_packet(const render::Device& device,
                                                const visibility::MethodOptions& options) {
  const visibility::ParsedOptions parsed = visibility::parse_options(packet_description(), options);
  const Extent packet = parsed[kPacket];
  const ContourChoices choices{.search = Search::mssm,
                               .traversal = parsed[kHierarchy] ? Traversal::hierarchy : Traversal::flat,
                               .packet_width = packet.width,
                               .packet_height = packet.height,
                               .divergence = parsed[kDivergence],
                               .sub_lights = parsed[kSubLights]};
  return subsampled(device,
                    make_map_method(device, contour_recipe(device, packet_description(), choices, parsed), options),
                    parsed, options);
}

}  // namespace penumbra::maps
