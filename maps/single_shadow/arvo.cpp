// SPDX-License-Identifier: Apache-2.0
// Floods penumbrae from the borders of a hard shadow over the picture: Arvo, Hirvikorpi and Tyystjärvi 2004,
// "Approximate soft shadows with an image-space flood-fill algorithm", as described in the course notes of Eisemann et
// al. (2009, section 5.2.1). Departures: a border is between differing neighbouring pixels, in place of the result of a
// Sobel filter; distances are as seen from the light's centre; the flood runs on the processor.

#include "maps/single_shadow/methods.hpp"

#include "base/assert.hpp"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/single_shadow/arvo_probe.comp.spv.hpp"
#include "maps/single_shadow/flood.hpp"
#include "maps/single_shadow/options.hpp"
#include "maps/single_shadow/descriptions.hpp"
#include "visibility/receivers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace penumbra::maps {
namespace {

visibility::MeshVerdict arvo_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps(
      "penumbrae around the hard shadow of the light's centre, where its border is visible in the picture", mesh);
}

double light_at(std::uint32_t falloff, double t) {
  switch (falloff) {
    case gpu::kFalloffCubic:
      return t * t * (3 - 2 * t);
    case gpu::kFalloffSine:
      return 0.5 - 0.5 * std::cos(std::numbers::pi * t);
    default:
      return t;
  }
}

/// Floods the results of a map method (arvo_probe.comp) at each pixel. Processes a whole picture at once, with its
/// first tile.
class FloodedShadow final : public visibility::Method {
 public:
  FloodedShadow(std::unique_ptr<visibility::Method> probe, std::uint32_t falloff)
      : probe_(std::move(probe)), falloff_(falloff) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return probe_->description(); }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    probe_->prepare_mesh(scene);
  }
  void prepare_light(const visibility::Light& light) override {
    probe_->prepare_light(light);
    light_ = &light;
    whole_.clear();
  }
  void prepare_view(const visibility::ViewSamples& samples) override {
    probe_->prepare_view(samples);
    samples_ = &samples;
    whole_.clear();
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    return samples_ == nullptr ? 1 : std::max(samples_->height, 1U);
  }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override;

  std::vector<visibility::PassTime> take_pass_times() override { return probe_->take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    auto counters = probe_->counters();
    counters["floodPasses"] = passes_;
    return counters;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return probe_->memory_bytes(); }

 private:
  [[nodiscard]] std::vector<float> probed();

  std::unique_ptr<visibility::Method> probe_;
  std::uint32_t falloff_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  std::vector<float> whole_;  ///< V of all pixels
  std::uint64_t passes_ = 0;
  visibility::Tile tile_{};
};

std::vector<float> FloodedShadow::probed() {
  std::vector<float> values(samples_->size());
  for (std::uint32_t row = 0; row < samples_->height;) {
    const std::uint32_t rows = std::min(probe_->max_tile_rows(), samples_->height - row);
    probe_->evaluate({row, rows});
    probe_->read_visibility(
        std::span(values).subspan(std::size_t{row} * samples_->width, std::size_t{rows} * samples_->width));
    row += rows;
  }
  return values;
}

void FloodedShadow::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "{}: evaluate before prepare_view", description().name);
  tile_ = tile;
  // The first tile of a picture computes the whole picture.
  if (!whole_.empty() && tile.first_row > 0) return;
  whole_ = probed();
  const LightBasis basis = light_basis(*light_);
  std::vector<FloodPixel> pixels(whole_.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    // Excluded are samples in the light's plane, samples that receive nothing, and samples that do not see the light's
    // front.
    if (!visibility::is_receiver(*scene_, *light_, *samples_, i) || whole_[i] == 0) continue;
    const glm::dvec3 d = basis.local(samples_->p[i]);
    if (d.z == 0) continue;
    pixels[i] = {.state = whole_[i] > 0 ? FloodPixel::State::lit : FloodPixel::State::shaded,
                 .seen = glm::dvec2(d) / std::abs(d.z),
                 .height = std::abs(d.z),
                 .blocker = -static_cast<double>(whole_[i])};
  }
  const FloodResult result = flood(pixels, samples_->width, half_width(*light_));
  passes_ = result.passes;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels[i].state != FloodPixel::State::nothing)
      whole_[i] = static_cast<float>(light_at(falloff_, result.share[i]));
  }
}

void FloodedShadow::read_visibility(std::span<float> visibility) {
  const std::size_t first = std::size_t{tile_.first_row} * (samples_ == nullptr ? 0 : samples_->width);
  PENUMBRA_ASSERT(first + visibility.size() <= whole_.size(), "{} values from pixel {} on of {}", visibility.size(),
                  first, whole_.size());
  std::ranges::copy(std::span(whole_).subspan(first, visibility.size()), visibility.begin());
}

}  // namespace

visibility::MethodDescription arvo_description() {
  visibility::MethodDescription description = single_shadow_description({.name = "arvo",
                                                                         .paper = "Arvo et al. 2004",
                                                                         .exact_for = "nothing",
                                                                         .options = compared_map_option_descriptions(),
                                                                         .verdict_on = arvo_verdict,
                                                                         .repairs = single_shadow_repairs});
  description.options.push_back(falloff_option(gpu::kFalloffCubic).description());
  return description;
}

std::unique_ptr<visibility::Method> make_arvo(const render::Device& device, const visibility::MethodOptions& options) {
  MapRecipe recipe{
      .description = arvo_description(), .look_up_name = "flood look-up", .look_up = shaders::kArvoProbeComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  return std::make_unique<FloodedShadow>(make_map_method(device, std::move(recipe), options),
                                         parsed[falloff_option(gpu::kFalloffCubic)]);
}

}  // namespace penumbra::maps
