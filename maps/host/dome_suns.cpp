// SPDX-License-Identifier: Apache-2.0
// Extends methods of maps to domes: the sky as suns of equal power (Debevec 2005). Departures: parts of the sky consist
// of the dome's light samples, which have equal power, not of texels; and a sun is a disk as wide as its part, not a
// single direction, so that shadows of methods with penumbrae have few steps.

#include "maps/host/dome_suns.hpp"

#include "base/assert.hpp"
#include "maps/host/median_cut.hpp"
#include "visibility/all_triangles.hpp"
#include "visibility/axes_around.hpp"
#include "visibility/changed_defaults.hpp"
#include "visibility/masks/visible_share.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

namespace penumbra::maps {
namespace {

using visibility::Light;
using visibility::Output;
using visibility::Tile;
using visibility::ViewSamples;

/// Tangent of the widest part of the sky represented by one sun.
constexpr double kWidest = 3;

/// Returns the fraction of a disk of this tangent around `middle` above the horizon of n.
double share_above(const Light& sun, const glm::dvec3& n) {
  const double height = glm::dot(n, glm::dvec3(sun.center));
  const double slope =
      sun.sun->tangent * std::hypot(glm::dot(n, glm::dvec3(sun.sun->axis_u)), glm::dot(n, glm::dvec3(sun.sun->axis_v)));
  if (height >= slope) return 1;
  if (height <= -slope) return 0;
  const double at = height / slope;
  return 1 - (std::acos(at) - at * std::sqrt((1 - at) * (1 + at))) / std::numbers::pi;
}

/// Returns nullopt if the sun would be too wide.
std::optional<DomeSun> sun_of(const Light& dome, std::vector<std::uint32_t> samples, bool own_samples) {
  glm::dvec3 middle(0);
  for (const std::uint32_t i : samples) middle += glm::normalize(glm::dvec3(dome.points[i]));
  if (!(glm::length(middle) > 0.25 * static_cast<double>(samples.size()))) return std::nullopt;
  middle = glm::normalize(middle);
  const visibility::Axes axes = visibility::axes_around(-middle);
  std::vector<glm::dvec2> places;  // on the plane at distance 1
  double widest = 0, squares = 0;
  for (const std::uint32_t i : samples) {
    const glm::dvec3 d(dome.points[i]);
    const double along = glm::dot(d, middle);
    if (!(along > 0)) return std::nullopt;
    places.emplace_back(glm::dot(d, axes.u) / along, glm::dot(d, axes.v) / along);
    const double square = glm::dot(places.back(), places.back());
    widest = std::max(widest, std::sqrt(square));
    squares += square / static_cast<double>(samples.size());
  }
  if (widest > kWidest) return std::nullopt;
  // The mean square of a disk is half its squared radius.
  const double tangent = own_samples ? widest : std::sqrt(2 * squares);
  DomeSun sun{dome, std::move(samples)};
  sun.light.kind = visibility::LightKind::sun;
  sun.light.dome.reset();
  sun.light.sun = Light::Directions{glm::vec3(axes.u) + 0.0F, glm::vec3(axes.v) + 0.0F, tangent};
  sun.light.center = sun.light.center_u = sun.light.center_v = glm::vec3(middle) + 0.0F;
  sun.light.area = std::numbers::pi * tangent * tangent;
  sun.light.sample_colors.clear();
  sun.light.points.clear();
  sun.light.coordinates.clear();
  for (const glm::dvec2& place : places) {
    const glm::dvec2 at = tangent > 0 ? place / std::max(tangent, widest) : place;
    sun.light.coordinates.push_back(at);
    sun.light.points.emplace_back(glm::vec3(middle + tangent * (at.x * axes.u + at.y * axes.v)) + 0.0F);
  }
  return sun;
}

class DomeOfSuns final : public visibility::Method,
                         public visibility::PassesTriangles,
                         public visibility::ChangesDefaults {
 public:
  DomeOfSuns(std::unique_ptr<Method> method, std::uint32_t suns)
      : method_(std::move(method)), count_(suns), description_(with_dome_suns(method_->description())) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void want_pixels(std::span<const std::uint32_t> pixels) override { method_->want_pixels(pixels); }
  void want_form_factors(bool wanted) override { method_->want_form_factors(wanted); }
  void expect_frames() override { method_->expect_frames(); }
  void pass(const visibility::AllTriangles* all) override { visibility::pass(*method_, all); }
  void prepare_mesh(const visibility::SceneFloats& scene) override { method_->prepare_mesh(scene); }
  void prepare_light(const Light& light) override;
  void prepare_view(const ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;
  std::vector<visibility::PassTime> take_pass_times() override { return method_->take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    return dome_ == nullptr ? method_->counters() : counters_;
  }
  std::map<std::string, std::uint64_t> take_mesh_counters() override { return method_->take_mesh_counters(); }
  [[nodiscard]] visibility::MethodOptions changed_defaults() const override {
    return visibility::changed_defaults(*method_);
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return method_->memory_bytes(); }

 private:
  [[nodiscard]] bool gives_masks() const { return description_.output == Output::mask; }
  [[nodiscard]] std::span<const glm::vec3> normals() const {
    return std::span(samples_->n).subspan(std::size_t{tile_.first_row} * samples_->width, pixels_);
  }
  /// Adds a sun's result for a band of the tile, with `first` the band's first pixel in the tile.
  void add(const DomeSun& sun, std::size_t first, std::size_t count);

  std::unique_ptr<Method> method_;
  std::uint32_t count_;
  visibility::MethodDescription description_;
  const Light* dome_ = nullptr;  // null: the light is of another kind
  std::vector<DomeSun> suns_;
  const ViewSamples* samples_ = nullptr;
  Tile tile_;
  std::size_t pixels_ = 0;  // number of pixels of the tile
  std::vector<std::uint32_t> masks_, part_masks_;
  std::vector<double> light_, whole_;  // for each pixel: arriving light, and unoccluded light
  std::vector<float> part_;
  std::map<std::string, std::uint64_t> counters_;
};

void DomeOfSuns::prepare_light(const Light& light) {
  visibility::check_light(description_, light);
  dome_ = light.dome ? &light : nullptr;
  counters_.clear();
  suns_.clear();
  if (dome_ == nullptr) return method_->prepare_light(light);
  suns_ = dome_suns(light, count_, gives_masks());
  method_->prepare_light(suns_.front().light);
}

void DomeOfSuns::prepare_view(const ViewSamples& samples) {
  samples_ = &samples;
  if (dome_ == nullptr) method_->prepare_view(samples);
}

std::uint32_t DomeOfSuns::max_tile_rows() const {
  if (dome_ == nullptr) return method_->max_tile_rows();
  PENUMBRA_ASSERT(samples_ != nullptr, "{}: max_tile_rows before prepare_view", description_.name);
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;  // every tile evaluates all suns again
  const std::size_t pixel_bytes = gives_masks() ? std::size_t{4} * dome_->words_per_mask() : 2 * sizeof(double);
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(kMostBytes / (pixel_bytes * std::max(samples_->width, 1U)),
                                                            1, std::max(samples_->height, 1U)));
}

void DomeOfSuns::evaluate(const Tile& tile) {
  if (dome_ == nullptr) return method_->evaluate(tile);
  tile_ = tile;
  pixels_ = std::size_t{tile.row_count} * samples_->width;
  masks_.assign(gives_masks() ? pixels_ * dome_->words_per_mask() : 0, 0U);
  light_.assign(gives_masks() ? 0 : pixels_, 0.0);
  whole_ = light_;
  for (const DomeSun& sun : suns_) {
    method_->prepare_light(sun.light);
    method_->prepare_view(*samples_);
    for (std::uint32_t row = 0; row < tile.row_count;) {
      const Tile band{tile.first_row + row, std::min(std::max(method_->max_tile_rows(), 1U), tile.row_count - row)};
      method_->evaluate(band);
      add(sun, std::size_t{row} * samples_->width, std::size_t{band.row_count} * samples_->width);
      row += band.row_count;
    }
    for (const auto& [name, count] : method_->counters()) counters_[name] += count;
    counters_["domeSuns"] += 1;
  }
}

void DomeOfSuns::add(const DomeSun& sun, std::size_t first, std::size_t count) {
  if (gives_masks()) {
    const std::size_t own = sun.light.words_per_mask(), words = dome_->words_per_mask();
    part_masks_.resize(count * own);
    method_->read_masks(part_masks_);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < sun.samples.size(); ++k) {
        const std::uint32_t bit = part_masks_[i * own + k / 32] >> (k % 32) & 1U, to = sun.samples[k];
        masks_[(first + i) * words + to / 32] |= bit << (to % 32);
      }
    }
    return;
  }
  part_.resize(count);
  method_->read_visibility(part_);
  const std::span<const glm::vec3> n = normals();
  for (std::size_t i = 0; i < count; ++i) {
    const double cosine = glm::dot(glm::dvec3(n[first + i]), glm::dvec3(sun.light.center));
    if (!(cosine > 0)) continue;
    // The part of a sun above the horizon counts as the whole sun; for a method that uses the middle alone, the result
    // is limited to 1.
    const double power = cosine * static_cast<double>(sun.samples.size());
    const double seen = std::min(1.0, static_cast<double>(part_[i]) / share_above(sun.light, n[first + i]));
    whole_[first + i] += power;
    light_[first + i] += std::isnan(part_[i]) ? static_cast<double>(part_[i]) : power * seen;
  }
}

void DomeOfSuns::read_masks(std::span<std::uint32_t> masks) {
  if (dome_ == nullptr) return method_->read_masks(masks);
  PENUMBRA_ASSERT(masks.size() == masks_.size(), "{} words asked for, {} evaluated", masks.size(), masks_.size());
  std::ranges::copy(masks_, masks.begin());
}

void DomeOfSuns::read_visibility(std::span<float> visibility) {
  if (dome_ == nullptr) return method_->read_visibility(visibility);
  PENUMBRA_ASSERT(visibility.size() == pixels_, "{} values for a tile of {} pixels", visibility.size(), pixels_);
  if (gives_masks()) return visibility::visible_shares(*dome_, masks_, normals(), visibility);
  for (std::size_t i = 0; i < pixels_; ++i) {
    const bool shown =
        samples_->triangle[std::size_t{tile_.first_row} * samples_->width + i] != ViewSamples::kBackground;
    visibility[i] = !shown ? 1.0F : whole_[i] > 0 ? static_cast<float>(light_[i] / whole_[i]) : 0.0F;
  }
}

}  // namespace

std::vector<DomeSun> dome_suns(const Light& dome, std::uint32_t count, bool own_samples) {
  for (;; count *= 2) {
    std::vector<DomeSun> suns;
    for (std::vector<std::uint32_t>& part : median_cut(dome.points, dome.dome->axes, count)) {
      std::optional<DomeSun> sun = sun_of(dome, std::move(part), own_samples);
      if (!sun) break;
      suns.push_back(*std::move(sun));
      if (suns.size() == std::min<std::size_t>(count, dome.points.size())) return suns;
    }
    PENUMBRA_ASSERT(count <= dome.points.size(), "light \"{}\": a sun of one direction is too wide", dome.name);
  }
}

std::unique_ptr<visibility::Method> with_dome_suns(std::unique_ptr<visibility::Method> method, std::uint32_t suns) {
  return std::make_unique<DomeOfSuns>(std::move(method), suns);
}

visibility::MethodDescription with_dome_suns(visibility::MethodDescription description) {
  description.lights = description.lights | visibility::kDomes;
  return description;
}

}  // namespace penumbra::maps
