// SPDX-License-Identifier: Apache-2.0
// Computes contours of the texels that shade by marching squares, integrated around the light's centre: Guennebaud,
// Barthe and Paulin 2007, "High-quality adaptive soft shadow mapping". Departures: a texel is compared with the
// receiver's plane in the texel's direction (taps.glsl); whether the light's centre is inside a contour follows from
// the contour itself, not from the texel at the centre; up to five faces replace one perspective image; areas are added
// as integers.

#include "maps/backprojection/contours/methods.hpp"

#include "maps/backprojection/contours/contour_recipe.hpp"
#include "maps/backprojection/subsampled.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr visibility::ChoiceOption<Search, 4> kSearch = search_option(Search::hsm);
constexpr visibility::ChoiceOption kTraversal{
    "traversal",
    {{"flat", Traversal::flat}, {"hierarchy", Traversal::hierarchy}, {"minmax", Traversal::minmax}},
    Traversal::hierarchy,
    "search for contours, with the same result: in every cell of a kernel, below a node of the searched pyramid (or of "
    "an MSSM) over the kernel, or below a min-max pyramid's root"};

}  // namespace

visibility::MethodDescription contour_description() {
  visibility::MethodDescription description{
      .name = "contour",
      .family = visibility::Family::image,
      .paper = "Guennebaud et al. 2007",
      .output = visibility::Output::scalar,
      .exact_for =
          "nothing; in the limit of large maps, scenes in which all casters lie in one plane parallel to the light",
      .lights = visibility::kPlanarLights,
      .options = compared_map_option_descriptions(),
      .verdict_on = contour_verdict,
      .repairs = contour_repairs};
  description.options.push_back(kSearch.description());
  description.options.push_back(kTraversal.description());
  for (const auto& option : {kMapLevel.description(), kTexelBudget.description(), kBlendLevels.description()})
    description.options.push_back(option);
  description.options.push_back(kSubsample.description());
  description.options.push_back(kSubsampleBy.description());
  std::ranges::copy(window_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

std::unique_ptr<visibility::Method> make_contour(const render::Device& device,
                                                 const visibility::MethodOptions& options) {
  const visibility::ParsedOptions parsed = visibility::parse_options(contour_description(), options);
  const ContourChoices choices{
      .search = parsed[kSearch], .traversal = parsed[kTraversal], .levels = level_choice(parsed)};
  return subsampled(device,
                    make_map_method(device, contour_recipe(device, contour_description(), choices, parsed), options),
                    parsed, options);
}

}  // namespace penumbra::maps
