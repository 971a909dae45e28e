// SPDX-License-Identifier: Apache-2.0
// Common part of methods that use the camera's picture. The whole picture is evaluated at once, for any tiles; a
// dithered result is blurred over the 4 x 4 pixels of its pattern, as published, but not across steps of depth.

#include "maps/screen/screen_method.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "maps/host/error_repairs.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

class ScreenMethod final : public visibility::Method {
 public:
  ScreenMethod(visibility::MethodDescription description, const visibility::ParsedOptions& options,
               ScreenVisibility visibility)
      : description_(std::move(description)),
        radius_(options[kRadius]),
        dithers_(options[kDither]),
        visibility_(std::move(visibility)) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    diagonal_ = glm::length(glm::dvec3(scene.upper) - glm::dvec3(scene.lower));
  }
  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    whole_.clear();
  }
  void prepare_view(const visibility::ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return std::max(picture_.height(), 1U); }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override;
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return picture_.size() * (2 * sizeof(glm::dvec3) + sizeof(float) + 1);
  }

 private:
  [[nodiscard]] float blurred(std::span<const float> values, std::size_t pixel) const;

  visibility::MethodDescription description_;
  double radius_;
  bool dithers_;
  ScreenVisibility visibility_;
  double diagonal_ = 0;
  ScreenPicture picture_;
  std::vector<float> whole_;  ///< V of all pixels; empty: not yet computed
  visibility::Tile tile_{};
};

void ScreenMethod::prepare_view(const visibility::ViewSamples& samples) {
  std::optional<ScreenPicture> picture = ScreenPicture::of(samples);
  if (!picture) {
    throw InputError(
        "method {} uses the picture of a camera, but these view samples are not at a camera's pixels: take another "
        "method (edge-scatter, view-sample, raytrace)",
        description_.name);
  }
  picture_ = *std::move(picture);
  whole_.clear();
}

void ScreenMethod::evaluate(const visibility::Tile& tile) {
  tile_ = tile;
  // The first tile of a picture computes the whole picture.
  if (!whole_.empty() && tile.first_row > 0) return;
  const double radius = radius_ * diagonal_;
  std::vector<float> values(picture_.size(), 1.0F);
  for_each_index(values.size(), [&](std::size_t i) {
    if (!picture_.shows_surface(i)) return;
    const auto x = static_cast<std::uint32_t>(i % picture_.width()),
               y = static_cast<std::uint32_t>(i / picture_.width());
    const std::uint32_t dither = dithers_ ? x % kDitherWidth + kDitherWidth * (y % kDitherWidth) : 0;
    values[i] = static_cast<float>(std::clamp(visibility_(picture_, i, radius, dither), 0.0, 1.0));
  });
  whole_ = values;
  if (!dithers_) return;
  for_each_index(values.size(), [&](std::size_t i) {
    if (picture_.shows_surface(i)) whole_[i] = blurred(values, i);
  });
}

float ScreenMethod::blurred(std::span<const float> values, std::size_t pixel) const {
  const std::size_t width = picture_.width(), height = picture_.height(), x = pixel % width, y = pixel / width;
  const double far = radius_ * diagonal_;
  double sum = 0, count = 0;
  constexpr std::size_t kBefore = kDitherWidth / 2, kBehind = kDitherWidth - kBefore;
  for (std::size_t j = y - std::min(y, kBefore); j < std::min(y + kBehind, height); ++j) {
    for (std::size_t i = x - std::min(x, kBefore); i < std::min(x + kBehind, width); ++i) {
      const std::size_t other = j * width + i;
      if (!picture_.shows_surface(other)) continue;
      if (std::abs(picture_.point(other).z - picture_.point(pixel).z) > far) continue;
      sum += static_cast<double>(values[other]);
      count += 1;
    }
  }
  return static_cast<float>(sum / count);
}

void ScreenMethod::read_visibility(std::span<float> visibility) {
  const std::size_t first = std::size_t{tile_.first_row} * picture_.width();
  PENUMBRA_ASSERT(first + visibility.size() <= whole_.size(), "{} values from pixel {} on of {}", visibility.size(),
                  first, whole_.size());
  std::ranges::copy(std::span(whole_).subspan(first, visibility.size()), visibility.begin());
}

visibility::ErrorRepairs screen_repairs(const visibility::MethodDescription& /*method*/,
                                        const visibility::MethodOptions& /*given*/) {
  visibility::ErrorRepairs repairs;
  for (const visibility::ErrorCause cause : visibility::kErrorCauses)
    repairs.alone.push_back(inseparable(cause, "it uses the camera's picture, not maps of a light"));
  return repairs;
}

}  // namespace

visibility::MethodDescription screen_description(const std::string& name, const std::string& paper) {
  visibility::MethodDescription description;
  description.name = name;
  description.paper = paper;
  description.family = visibility::Family::image;
  description.output = visibility::Output::scalar;
  description.lights = visibility::kDomes;
  description.textures = false;
  description.on_request = true;
  description.options = {kRadius.description(), kDither.description()};
  description.repairs = screen_repairs;
  return description;
}

std::unique_ptr<visibility::Method> make_screen_method(visibility::MethodDescription description,
                                                       const visibility::ParsedOptions& options,
                                                       ScreenVisibility visibility) {
  return std::make_unique<ScreenMethod>(std::move(description), options, std::move(visibility));
}

}  // namespace penumbra::maps
