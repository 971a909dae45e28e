// SPDX-License-Identifier: Apache-2.0
// Computes V as the weighted mean of hard shadows from an adaptive set of light points: Schwärzler, "Real-time soft
// shadows with adaptive light source sampling". Shadow maps are rendered from the corners of the light; two maps of
// opposite corners are compared at the view samples, and if they differ at too many of them, the cell is split.
// Departures: pixels that are below the horizon of both points do not count, every tap is compared with the receiver's
// plane (taps.glsl), and the number of pixels that may differ is a fraction of the pixels (option shareOf: of a map's
// texels, as published, with which small pictures would have four maps).

#include "maps/sampling/methods.hpp"

#include "base/assert.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/host/receivers.hpp"
#include "maps/host/tile_visibility.hpp"
#include "maps/sampling/adaptive_light.comp.spv.hpp"
#include "maps/sampling/adaptive_light.shared.h"
#include "maps/sampling/adaptive_maps.hpp"
#include "maps/sampling/repairs.hpp"
#include "render/compute_pass.hpp"
#include "visibility/receivers.hpp"

#include <algorithm>
#include <utility>

namespace penumbra::maps {
namespace {

enum class CompareIn : std::uint8_t { camera, light };

constexpr visibility::IntegerOption kLevels{"levels", 0, 6, 3,
                                            "largest number of times that a cell of the light is halved"};
// Fraction of all pixels, so that pictures of any size are refined alike. With 0.02, 14 of the 81 maps of the paper's
// figure 1 are left, and V is within 1.3 times the error of 128 fixed maps (docs/adaptive-light.md).
constexpr visibility::RealOption kDifferingShare{
    "epsilon", 0, 1, 0.02,
    "fraction of differing pixels from which a cell is split; shareOf: the number to which it relates"};
constexpr visibility::RealOption kGamma{"gamma", 0, 1, 0.02,
                                        "relative difference in height from which two maps count as different at a "
                                        "pixel; gammaOf: relative to which height"};
constexpr visibility::ChoiceOption kGammaOf{"gammaOf",
                                            {{"height", false}, {"range", true}},
                                            false,
                                            "quantity to which gamma relates: the compared heights (equation 7), or "
                                            "all depths that a map can hold (equation 3)"};
constexpr visibility::ChoiceOption kCompare{"compare",
                                            {{"camera", CompareIn::camera}, {"light", CompareIn::light}},
                                            CompareIn::camera,
                                            "points at which maps are compared: the view samples, or the texels of a "
                                            "map from the light's centre, which does not depend on the camera"};
constexpr visibility::ChoiceOption kPcf{"pcf",
                                        {{"off", 1u},
                                         {"on", 2u},
                                         {"3", 3u},
                                         {"4", 4u},
                                         {"5", 5u},
                                         {"6", 6u},
                                         {"7", 7u},
                                         {"8", 8u},
                                         {"9", 9u},
                                         {"13", 13u},
                                         {"17", 17u}},
                                        2u,
                                        "filters each map over the n x n texels around the receiver; on: 2 x 2"};
constexpr visibility::ChoiceOption kForm{"form",
                                         {{"area", LightTree::Shape::area}, {"line", LightTree::Shape::line}},
                                         LightTree::Shape::area,
                                         "line: points on the light's longer middle line alone"};
constexpr visibility::ChoiceOption kWeights{
    "weights",
    {{"paper", PointWeights::paper}, {"equal", PointWeights::equal}, {"area", PointWeights::area}},
    PointWeights::paper,
    "weights of the maps: the paper's, none, or each cell's area shared by its corners"};
constexpr visibility::ChoiceOption kShareOf{
    "shareOf",
    {{"map", true}, {"pixels", false}},
    false,
    "quantity to which epsilon relates: texels of a map, as published, or all pixels (texels) compared"};
constexpr visibility::IntegerOption kMostMaps{"maps", 4, 4225, 512, "largest number of light points"};
constexpr visibility::IntegerOption kAdaptiveSize = map_size(512);

visibility::MeshVerdict adaptive_light_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("hard shadows from more and more points of the light, as long as their maps differ", mesh);
}

}  // namespace

visibility::MethodDescription adaptive_light_description() {
  visibility::MethodDescription description{
      .name = "adaptive-light",
      .family = visibility::Family::image,
      .paper = "Schwärzler",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps and many levels any soup of triangles that can be rasterised",
      .lights = visibility::kPlanarLights,
      .options = map_option_descriptions(kAdaptiveSize),
      .verdict_on = adaptive_light_verdict,
      .repairs = sampling_repairs};
  for (const visibility::OptionDescription& option :
       {kLevels.description(), kDifferingShare.description(), kGamma.description(), kGammaOf.description(),
        kCompare.description(), kPcf.description(), kForm.description(), kWeights.description(), kShareOf.description(),
        kMostMaps.description()}) {
    description.options.push_back(option);
  }
  return description;
}

namespace {

class AdaptiveLight final : public visibility::Method {
 public:
  AdaptiveLight(const render::Device& device, const MapOptions& map, const AdaptiveChoices& choices, CompareIn compare,
                std::uint32_t taps)
      : device_(&device),
        description_(adaptive_light_description()),
        compare_(compare),
        taps_(taps),
        maps_(device, map, choices),
        look_up_(device, {.name = "adaptive-light look-up",
                          .spirv = shaders::kAdaptiveLightComp,
                          .push_bytes = sizeof(gpu::LookupPush) + sizeof(gpu::AdaptivePush),
                          .constants = {}}) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override;
  void prepare_light(const visibility::Light& light) override;
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    return receivers_.max_rows(*device_, sizeof(std::uint32_t));
  }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override { results_.read(visibility); }

  std::vector<visibility::PassTime> take_pass_times() override { return maps_.take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return maps_.counters(); }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return maps_.memory_bytes() + receivers_.memory_bytes() + results_.memory_bytes();
  }

 private:
  [[nodiscard]] ComparedReceivers pixels() const;

  const render::Device* device_;
  visibility::MethodDescription description_;
  CompareIn compare_;
  std::uint32_t taps_;  ///< on a side, in texels
  AdaptiveMaps maps_;
  render::ComputePass look_up_;
  Receivers receivers_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  std::uint64_t receiving_ = 0;  ///< number of pixels of the view that receive shadow
  TileVisibility results_;
};

void AdaptiveLight::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  maps_.set_scene(scene);
}

void AdaptiveLight::prepare_light(const visibility::Light& light) {
  visibility::check_light(description_, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_light before prepare_mesh", description_.name);
  light_ = &light;
  maps_.set_light(light);
  if (compare_ == CompareIn::light) maps_.refine(maps_.centre_texels());
}

void AdaptiveLight::prepare_view(const visibility::ViewSamples& samples) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: prepare_view before prepare_light", description_.name);
  receivers_.upload(*device_, *scene_, *light_, samples);
  receiving_ = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    receiving_ += visibility::is_receiver(*scene_, *light_, samples, i) ? 1 : 0;
  if (compare_ == CompareIn::camera && maps_.refined()) maps_.restart();  // another view
}

ComparedReceivers AdaptiveLight::pixels() const {
  ComparedReceivers places{.parts = {}, .count = receiving_};
  for (const Receivers::Part& part : receivers_.parts({0, receivers_.height()})) {
    places.parts.push_back({part.receivers, part.count});
  }
  return places;
}

void AdaptiveLight::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: evaluate before prepare_light", description_.name);
  if (!maps_.refined()) maps_.refine(pixels());
  if (!results_.begin(*device_, tile, receivers_)) return;
  render::Commands commands(*device_);
  const std::uint32_t points = maps_.point_count();
  for (std::uint32_t first = 0; first < points; first += maps_.maps_per_buffer()) {
    const std::uint32_t count = std::min(maps_.maps_per_buffer(), points - first);
    const gpu::AdaptivePush own{
        .taps = taps_, .last = first + count == points ? 1u : 0u, .total = maps_.total_weight()};
    for (const Receivers::Part& part : receivers_.parts(tile)) {
      gpu::LookupPush look_up = maps_.push();
      look_up.first_receiver = part.first_receiver;
      look_up.receiver_count = part.count;
      look_up.first_result = part.first_result;
      look_up.first_point = first;
      look_up.point_count = count;
      const std::vector<render::BufferReference> buffers{*part.receivers, maps_.views(), maps_.maps_of(first),
                                                         results_.buffer(), maps_.weights()};
      const std::vector<std::uint32_t> words = push_words(look_up, own);
      look_up_.record(commands, std::as_bytes(std::span(words)), buffers, part.groups());
    }
    maps_.add(commands.submit());
  }
}

}  // namespace

std::unique_ptr<visibility::Method> make_adaptive_light(const render::Device& device,
                                                        const visibility::MethodOptions& options) {
  const visibility::MethodDescription description = adaptive_light_description();
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  const AdaptiveChoices choices{.levels = parsed[kLevels],
                                .most_maps = parsed[kMostMaps],
                                .epsilon = parsed[kDifferingShare],
                                .gamma = parsed[kGamma],
                                .gamma_of_range = parsed[kGammaOf],
                                .taps = parsed[kPcf],
                                .form = parsed[kForm],
                                .weights = parsed[kWeights],
                                .share_of_map = parsed[kShareOf]};
  return std::make_unique<AdaptiveLight>(device, map_options(device, description, parsed), choices, parsed[kCompare],
                                         parsed[kPcf]);
}

}  // namespace penumbra::maps
