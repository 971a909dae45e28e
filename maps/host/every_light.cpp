// SPDX-License-Identifier: Apache-2.0
// Adapts methods of maps to suns (projective space), spheres (disks) and surfaces with holes. Not from a paper.

#include "maps/host/every_light.hpp"

#include "base/assert.hpp"
#include "maps/host/holes.hpp"
#include "maps/host/lamp_disks.hpp"
#include "maps/host/scene_space.hpp"
#include "maps/host/sun_space.hpp"
#include "visibility/all_triangles.hpp"
#include "visibility/changed_defaults.hpp"
#include "visibility/frame_memory.hpp"
#include "visibility/receivers.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

using visibility::Light;
using visibility::Output;
using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

class EveryLight final : public visibility::Method,
                         public visibility::RemembersFrames,
                         public visibility::PassesTriangles,
                         public visibility::ChangesDefaults {
 public:
  EveryLight(std::unique_ptr<Method> method, Given given)
      : method_(std::move(method)), given_(given), description_(for_every_light(method_->description(), given)) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void want_pixels(std::span<const std::uint32_t> pixels) override { method_->want_pixels(pixels); }
  void want_form_factors(bool wanted) override { method_->want_form_factors(wanted); }
  void expect_frames() override { method_->expect_frames(); }
  void remember(visibility::FrameMemory* memory) override { visibility::remember(*method_, memory); }
  void pass(const visibility::AllTriangles* all) override { all_ = all; }
  void prepare_mesh(const SceneFloats& scene) override;
  void prepare_light(const Light& light) override;
  void prepare_view(const ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return method_->max_tile_rows(); }
  void evaluate(const Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_visibility(std::span<float> visibility) override;
  std::vector<visibility::PassTime> take_pass_times() override { return method_->take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override;
  std::map<std::string, std::uint64_t> take_mesh_counters() override { return method_->take_mesh_counters(); }
  [[nodiscard]] visibility::MethodOptions changed_defaults() const override {
    return visibility::changed_defaults(*method_);
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return std::max(memory_, method_->memory_bytes()); }

 private:
  static constexpr std::uint8_t kNoDisk = 0xff;

  [[nodiscard]] const SceneFloats& drawn() const { return drawn_ ? *drawn_ : *scene_; }
  /// Gives the method a scene, unless the method already has this scene.
  void show(const SceneFloats& scene);
  /// Gives the method one disk of the lamp, unless the method already has this disk, and the view samples lit by the
  /// disk.
  void look_from(std::uint32_t number);
  void show_lit();

  std::unique_ptr<Method> method_;
  Given given_;
  visibility::MethodDescription description_;
  const SceneFloats* scene_ = nullptr;
  const visibility::AllTriangles* all_ = nullptr;  // null: the scene has all triangles
  std::optional<SceneFloats> drawn_;               // scene with holes as casters, if it has any
  const SceneFloats* shown_ = nullptr;             // scene that the method has
  const Light* light_ = nullptr;                   // light given by the host
  Light own_;                                      // light given to the method, where it differs
  std::optional<SunSpace> sun_;                    // space of the most recent sun: the next sun may have the same
                                                   // direction
  bool in_sun_space_ = false;                      // the light is this sun
  std::optional<LampDisks> lamp_;                  // disks of a sphere that the method does not support
  std::uint32_t disk_ = 0;                         // of a lamp: the method's current disk
  std::uint32_t looked_ = kNoDisk;                 // of a lamp: the current disk for which the method has the lit view
                                                   // samples
  ViewSamples samples_;                            // view samples given to the method, transformed for these lights
  std::vector<std::int32_t> carriers_;             // of a lamp: carriers of all view samples
  std::vector<std::uint8_t> disks_;                // of a lamp: for each view sample, the index of its disk, or kNoDisk
  std::vector<std::uint32_t> masks_;               // of a lamp: masks of the most recent tile
  std::vector<float> visibility_;                  // of a lamp: V of the most recent tile
  std::map<std::string, std::uint64_t> counters_;  // of a lamp: sums over all evaluated disks
  std::map<std::string, std::uint64_t> counted_;   // part of counters_ from the method's current disk
  std::uint64_t memory_ = 0;
};

void EveryLight::prepare_mesh(const SceneFloats& scene) {
  scene_ = &scene;
  shown_ = nullptr;
  sun_.reset();
  drawn_.reset();
  if (given_.holes) drawn_ = with_holes_drawn(scene);
  in_sun_space_ = false;
  show(drawn());
}

void EveryLight::show(const SceneFloats& scene) {
  if (shown_ == &scene) return;
  visibility::pass(*method_, in_sun_space_ && all_ != nullptr ? &*sun_ : all_);
  method_->prepare_mesh(scene);
  shown_ = &scene;
}

void EveryLight::prepare_light(const Light& light) {
  visibility::check_light(description_, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_light before prepare_mesh", description_.name);
  light_ = &light;
  lamp_.reset();
  counters_.clear();
  counted_.clear();
  own_ = light;
  const bool knows = method_->description().lights.contains(light.kind);
  in_sun_space_ = light.sun && !knows;
  if (in_sun_space_) {
    if (!sun_ || !sun_->take(light)) {
      shown_ = nullptr;  // a new scene of a sun may have the same address as the previous one
      sun_.emplace(drawn(), light, all_);
    }
    own_ = sun_->light();
  } else if (!knows) {
    PENUMBRA_ASSERT(all_ == nullptr, "{}: a lamp's disks look at triangles more than once", description_.name);
    lamp_.emplace(light);
    disk_ = 0;
    looked_ = kNoDisk;
    own_ = lamp_->disk(disk_);
  }
  // The host removes dimming by translucent surfaces from the light; the method handles all other casters.
  if (given_.holes) own_.filtered_by.clear();
  own_.dimmed_by.clear();
  show(in_sun_space_ ? sun_->scene() : drawn());
  if (auto* sees = dynamic_cast<SeesScene*>(method_.get())) {
    sees->see_through(in_sun_space_ ? sun_->space() : SceneSpace());
  }
  method_->prepare_light(own_);
}

void EveryLight::prepare_view(const ViewSamples& samples) {
  PENUMBRA_ASSERT(light_ != nullptr, "{}: prepare_view before prepare_light", description_.name);
  if (in_sun_space_) {
    samples_ = sun_->mapped(samples);
    method_->prepare_view(samples_);
    return;
  }
  if (!lamp_) {
    method_->prepare_view(samples);
    return;
  }
  samples_ = samples;
  carriers_ = samples.triangle;
  disks_.assign(samples.size(), kNoDisk);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!visibility::is_receiver(*scene_, *light_, samples, i)) continue;
    disks_[i] = static_cast<std::uint8_t>(lamp_->number_of(samples.p[i]));
  }
  static_assert(LampDisks::kCount < kNoDisk);
  looked_ = disk_;
  show_lit();  // so that max_tile_rows() has a light and view samples
}

void EveryLight::show_lit() {
  for (std::size_t i = 0; i < disks_.size(); ++i)
    samples_.triangle[i] = disks_[i] == looked_ ? carriers_[i] : ViewSamples::kBackground;
  method_->prepare_view(samples_);
}

void EveryLight::look_from(std::uint32_t number) {
  if (number == looked_) return;
  looked_ = number;
  if (number != disk_) {
    disk_ = number;
    own_ = lamp_->disk(number);
    if (given_.holes) own_.filtered_by.clear();
    own_.dimmed_by.clear();
    method_->prepare_light(own_);
    counted_.clear();
  }
  show_lit();
}

void EveryLight::evaluate(const Tile& tile) {
  if (!lamp_) {
    method_->evaluate(tile);
    return;
  }
  const std::size_t first = std::size_t{tile.first_row} * samples_.width;
  const std::size_t count = std::size_t{tile.row_count} * samples_.width;
  const bool gives_masks = description_.output == Output::mask;
  const std::size_t words = gives_masks ? light_->words_per_mask() : 0;
  visibility_.assign(count, 1.0F);
  masks_.assign(count * words, 0xffffffffU);
  const std::uint32_t rest = light_->sample_count() % 32;
  if (rest != 0) {
    for (std::size_t i = 0; i < count * words; i += words) masks_[i + words - 1] = (1U << rest) - 1;
  }
  const std::span<const std::uint8_t> here = std::span(disks_).subspan(first, count);
  std::vector<float> visibility(count);
  std::vector<std::uint32_t> masks(count * words);
  for (std::uint32_t disk = 0; disk < LampDisks::kCount; ++disk) {
    if (std::ranges::find(here, static_cast<std::uint8_t>(disk)) == here.end()) continue;
    look_from(disk);  // with view samples of other tiles, from which some methods choose their viewpoint
    method_->evaluate(tile);
    method_->read_visibility(visibility);
    if (gives_masks) method_->read_masks(masks);
    for (std::size_t i = 0; i < count; ++i) {
      if (here[i] != disk) continue;
      visibility_[i] = visibility[i];
      std::copy_n(masks.begin() + static_cast<std::ptrdiff_t>(i * words), words,
                  masks_.begin() + static_cast<std::ptrdiff_t>(i * words));
    }
    if (counted_.empty()) counters_["lampDisks"] += 1;
    for (const auto& [name, value] : method_->counters()) {
      counters_[name] += value - counted_[name];
      counted_[name] = value;
    }
    memory_ = std::max(memory_, method_->memory_bytes());
  }
}

void EveryLight::read_masks(std::span<std::uint32_t> masks) {
  if (!lamp_) return method_->read_masks(masks);
  PENUMBRA_ASSERT(masks.size() == masks_.size(), "{} words for masks of {}", masks.size(), masks_.size());
  std::ranges::copy(masks_, masks.begin());
}

void EveryLight::read_visibility(std::span<float> visibility) {
  if (!lamp_) return method_->read_visibility(visibility);
  PENUMBRA_ASSERT(visibility.size() == visibility_.size(), "{} values for a tile of {} pixels", visibility.size(),
                  visibility_.size());
  std::ranges::copy(visibility_, visibility.begin());
}

std::map<std::string, std::uint64_t> EveryLight::counters() const {
  return lamp_ ? counters_ : method_->counters();
}

}  // namespace

std::unique_ptr<visibility::Method> for_every_light(std::unique_ptr<visibility::Method> method, Given given) {
  return std::make_unique<EveryLight>(std::move(method), given);
}

visibility::MethodDescription for_every_light(visibility::MethodDescription description, Given given) {
  if (given.suns) description.lights = description.lights | visibility::LightKinds{visibility::LightKind::sun};
  if (given.spheres) description.lights = description.lights | visibility::kBodies;
  description.draws_holes = given.holes;
  return description;
}

}  // namespace penumbra::maps
