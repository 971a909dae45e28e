// SPDX-License-Identifier: Apache-2.0
// Computes the contours of `contour` once for a packet of pixels and below the nodes of a multi-scale pyramid, with the
// light cut into sub-lights with a map each: Yang, Feng, Guennebaud and Liu 2009, "Packet-based hierarchal soft shadow
// mapping". Departures: those of contour; a texel makes a packet incoherent where the texel is near some pixel's plane
// in its own direction, not where its depth is between the pixels' (thresholds.glsl); an incoherent packet is processed
// pixel by pixel by the same workgroup, not in a second pass; a sub-light has its part of the light's texture.

#include "maps/backprojection/contours/methods.hpp"

#include "base/error.hpp"
#include "maps/backprojection/contours/contour.shared.h"
#include "maps/backprojection/contours/contour_recipe.hpp"
#include "maps/backprojection/subsampled.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

struct Extent {
  std::uint32_t width = 0, height = 0;
};
constexpr const char* kPacket = "packet";

/// Returns the option as listed by `methods`; any other W x H with no more pixels is also accepted.
visibility::OptionDescription packet_option() {
  return {.name = kPacket,
          .choices = {"1x1", "2x1", "2x2", "3x2", "3x3", "4x2", "4x4", "5x5", "8x4", "8x8"},
          .default_value = "3x3",
          .help = fmt::format("WxH pixels that search for contours together: these sizes, or others of up to {} pixels",
                              gpu::kMostPacketPixels)};
}

/// Parses "4x3". Throws UsageError unless `text` is two whole numbers of at least 1 with few enough pixels.
Extent extent_of(const std::string& text) {
  Extent extent;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, extent.width);
  const bool cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height = cross ? std::from_chars(width.ptr + 1, end, extent.height) : width;
  const bool whole = cross && height.ec == std::errc() && height.ptr == end;
  if (!whole || extent.width == 0 || extent.height == 0 ||
      std::uint64_t{extent.width} * extent.height > gpu::kMostPacketPixels) {
    throw UsageError(
        "method packet: option {} is \"{}\"; it must be WxH: the number of pixels across and down, at least 1x1 and at "
        "most {} pixels in all",
        kPacket, text, gpu::kMostPacketPixels);
  }
  return extent;
}

/// Returns the given option, or its default.
std::string packet_text(const visibility::MethodOptions& options) {
  const auto given = options.find(kPacket);
  return given == options.end() ? packet_option().default_value : given->second;
}

constexpr visibility::IntegerOption kSubLights{
    "sublights", 1, 16, 1, "number of parts of the light along each axis, each with a separate map; V is their mean"};
constexpr auto kHierarchy =
    visibility::flag_option("hierarchy", true, "find contours below nodes of a multi-scale pyramid, not cell by cell");
constexpr visibility::RealOption kDivergence{
    "divergence", 0, 1, 0.8,
    "probability of different contours among a packet's pixels above which the packet is processed pixel by pixel"};

// Both costs are 1 and not tuned (docs/packet.md).
constexpr visibility::RealOption kEdgeCost{
    "edgeCost", 0, 1024, 1, "cost of an edge of a contour, relative to a node: decides which packets search together"};
constexpr visibility::RealOption kAreaCost{
    "areaCost", 0, 1024, 1,
    "cost of an edge's area for each pixel, relative to a node: decides which packets search together"};

}  // namespace

visibility::MethodDescription packet_description(const visibility::MethodOptions& options) {
  visibility::MethodDescription description{
      .name = "packet",
      .family = visibility::Family::image,
      .paper = "Yang et al. 2009",
      .output = visibility::Output::scalar,
      .exact_for =
          "nothing; in the limit of large maps, scenes in which all casters lie in one plane parallel to the light",
      .lights = visibility::kPlanarLights,
      .options = compared_map_option_descriptions(),
      .verdict_on = contour_verdict,
      .repairs = contour_repairs};
  description.options.push_back(packet_option());
  std::vector<std::string>& extents = description.options.back().choices;
  const std::string packet = packet_text(options);
  extent_of(packet);
  if (std::ranges::find(extents, packet) == extents.end()) extents.push_back(packet);
  description.options.push_back(kSubLights.description());
  description.options.push_back(kHierarchy.description());
  description.options.push_back(kDivergence.description());
  description.options.push_back(kEdgeCost.description());
  description.options.push_back(kAreaCost.description());
  for (const auto& option : {kMapLevel.description(), kTexelBudget.description(), kBlendLevels.description()})
    description.options.push_back(option);
  description.options.push_back(kSubsample.description());
  description.options.push_back(kSubsampleBy.description());
  std::ranges::copy(window_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

std::unique_ptr<visibility::Method> make_packet(const render::Device& device,
                                                const visibility::MethodOptions& options) {
  const visibility::MethodDescription description = packet_description(options);
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  const Extent packet = extent_of(packet_text(options));
  const ContourChoices choices{.search = Search::mssm,
                               .traversal = parsed[kHierarchy] ? Traversal::hierarchy : Traversal::flat,
                               .packet_width = packet.width,
                               .packet_height = packet.height,
                               .divergence = parsed[kDivergence],
                               .edge_cost = parsed[kEdgeCost],
                               .area_cost = parsed[kAreaCost],
                               .sub_lights = parsed[kSubLights],
                               .levels = level_choice(parsed)};
  return subsampled(device, make_map_method(device, contour_recipe(device, description, choices, parsed), options),
                    parsed, options);
}

}  // namespace penumbra::maps
