// SPDX-License-Identifier: Apache-2.0
// Scherzer, Jeschke and Wimmer 2007, "Pixel-correct shadow maps with temporal reprojection and shadow test confidence",
// as described in the course notes of Eisemann et al. (2009, section 3.2.6): each frame has a map with displaced
// texels, and V of a pixel is mixed from this frame's V and the stored V, by the confidence 1 - 2 max |position -
// texel's centre|. The stored V is that of the pixel's place in the previous picture, unless another surface is seen
// there. Departure: history=N makes N frames of each picture, as for a still camera; these depend on no other picture.

#include "maps/filters/history.hpp"

#include "base/assert.hpp"
#include "base/memory.hpp"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_fit.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

/// Radical inverse: the digits of i in this base, mirrored at the point.
double mirrored(std::uint32_t i, std::uint32_t base) {
  double value = 0, digit = 1;
  for (; i != 0; i /= base) value += (digit /= base) * (i % base);
  return value;
}

/// Bytes of a view sample and its V (KeptPicture).
constexpr std::uint64_t kBytesKept = sizeof(std::int32_t) + 2 * sizeof(glm::vec3) + 2 * sizeof(float) + 1;

class History final : public visibility::Method, public visibility::RemembersFrames {
 public:
  History(std::unique_ptr<Method> method, std::unique_ptr<glm::dvec2> jitter, const HistoryOptions& options)
      : jitter_(std::move(jitter)), method_(std::move(method)), options_(options) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return method_->description(); }
  void want_pixels(std::span<const std::uint32_t> pixels) override { method_->want_pixels(pixels); }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    method_->prepare_mesh(scene);
  }
  void prepare_light(const visibility::Light& light) override {
    light_ = &light;
    reprojected_ = 0;
    *jitter_ = glm::dvec2(0);
    method_->prepare_light(light);
  }
  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    method_->prepare_view(samples);
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override { return method_->max_tile_rows(); }
  void remember(visibility::FrameMemory* memory) override { memory_ = options_.reproject ? memory : nullptr; }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override {
    PENUMBRA_ASSERT(visibility.size() == mixed_.size(), "{} values for a tile of {}", visibility.size(), mixed_.size());
    std::ranges::copy(mixed_, visibility.begin());
  }
  std::vector<visibility::PassTime> take_pass_times() override { return method_->take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    auto counters = method_->counters();
    counters["historyFrames"] = options_.frames;
    if (options_.reproject) counters["reprojectedPixels"] = reprojected_;
    return counters;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    std::uint64_t kept = 0;
    if (memory_ != nullptr) {
      for (const auto* pictures : {&memory_->before, &memory_->now}) {
        for (const auto& [light, picture] : *pictures) kept += picture.visibility.size() * kBytesKept;
      }
    }
    return method_->memory_bytes() + kept;
  }

 private:
  std::unique_ptr<glm::dvec2> jitter_;
  std::unique_ptr<Method> method_;
  HistoryOptions options_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  visibility::FrameMemory* memory_ = nullptr;
  std::uint64_t reprojected_ = 0;
  std::vector<float> mixed_;  ///< V of the tile last evaluated

  [[nodiscard]] visibility::FrameMemory::Key key() const { return {light_->index, light_->piece}; }
  /// Returns V of the tile in the previous picture; NaN at pixels whose surface that picture does not show.
  [[nodiscard]] std::vector<float> before(const visibility::Tile& tile);
  void keep(const visibility::Tile& tile);
};

/// Confidence of a point: 1 at the centre of its texel, 0 on the texel's border and in directions without a face.
double confidence(const std::vector<Face>& faces, const glm::dvec3& d, std::uint32_t size) {
  for (const Face& face : faces) {
    const double w = glm::dot(d, face.w);
    if (!(w > 0)) continue;
    const glm::dvec2 at(glm::dot(d, face.a) / w, glm::dot(d, face.b) / w);
    if (glm::any(glm::lessThan(at, face.lower)) || glm::any(glm::greaterThan(at, face.upper))) continue;
    const glm::dvec2 place = (at - face.lower) / (face.upper - face.lower) * static_cast<double>(size);
    const glm::dvec2 off = glm::abs(place - glm::floor(place) - 0.5);
    return 1 - 2 * std::max(off.x, off.y);
  }
  return 0;
}

void History::evaluate(const visibility::Tile& tile) {
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  const LightBasis basis = light_basis(*light_, *scene_);
  const glm::vec3 centre(basis.center);
  std::vector<float> now(std::size_t{tile.row_count} * samples_->width);
  mixed_ = before(tile);
  const std::uint32_t earlier = memory_ != nullptr ? memory_->frame * options_.frames : 0;
  for (std::uint32_t frame = 0; frame < options_.frames; ++frame) {
    *jitter_ = jitter_of(earlier + frame);
    method_->prepare_light(*light_);
    method_->prepare_view(*samples_);
    method_->evaluate(tile);
    method_->read_visibility(now);
    const FittedViews fitted =
        fit_views(*scene_, *light_, basis, {&centre, 1}, {.size = options_.size, .jitter = *jitter_});
    std::vector<Face> faces;
    for (std::uint32_t i = 0; i < fitted.faces; ++i) faces.push_back(face_of(fitted.views.front(), basis, i));
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (samples_->triangle[first + i] == visibility::ViewSamples::kBackground) continue;
      if (std::isnan(mixed_[i])) {
        mixed_[i] = now[i];
        continue;
      }
      const glm::dvec3 d = glm::dvec3(samples_->p[first + i]) - glm::dvec3(centre);
      const auto share = static_cast<float>(confidence(faces, d, options_.size));
      mixed_[i] = share * now[i] + (1 - share) * mixed_[i];
    }
  }
  keep(tile);
}

std::vector<float> History::before(const visibility::Tile& tile) {
  const std::size_t first = std::size_t{tile.first_row} * samples_->width;
  std::vector<float> found(std::size_t{tile.row_count} * samples_->width, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (samples_->triangle[first + i] == visibility::ViewSamples::kBackground) found[i] = 1;
  }
  if (memory_ == nullptr) return found;
  const auto kept = memory_->before.find(key());
  if (kept == memory_->before.end()) return found;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (samples_->triangle[first + i] == visibility::ViewSamples::kBackground) continue;
    found[i] = reprojected(kept->second, *samples_, first + i);
    reprojected_ += std::isnan(found[i]) ? 0 : 1;
  }
  return found;
}

void History::keep(const visibility::Tile& tile) {
  if (memory_ == nullptr) return;
  visibility::KeptPicture& picture = memory_->now[key()];
  if (picture.visibility.size() != samples_->size())
    require_memory(samples_->size() * kBytesKept, "V of the previous frame, for one more light",
                   "choose a smaller --size, or leave out reproject=on");
  if (tile.first_row == 0 || picture.visibility.size() != samples_->size()) {
    picture = {*samples_, std::vector<float>(samples_->size(), std::numeric_limits<float>::quiet_NaN())};
  }
  std::ranges::copy(
      mixed_, picture.visibility.begin() + static_cast<std::ptrdiff_t>(std::size_t{tile.first_row} * samples_->width));
}

}  // namespace

float reprojected(const visibility::KeptPicture& before, const visibility::ViewSamples& samples, std::size_t pixel) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  // Surfaces whose depths differ by less count as one: this allows for rounding, and for a surface curved within a
  // pixel.
  constexpr double kSameDepth = 0x1p-10;
  const visibility::PinholeCamera& camera = before.samples.camera;
  const glm::dvec3 p(samples.p[pixel]), n(samples.n[pixel]), d = p - camera.eye;
  const double depth = glm::dot(camera.forward, d);
  if (camera.half_height || !(depth > 0)) return kNone;
  const double width = before.samples.width, height = before.samples.height;
  const double x = 0.5 * (glm::dot(camera.screen_across(), d) / depth + 1) * width - 0.5;
  const double y = 0.5 * (1 - glm::dot(camera.screen_upward(), d) / depth) * height - 0.5;
  if (!(x > -1 && y > -1 && x < width && y < height)) return kNone;
  double sum = 0, weights = 0;
  for (const double row : {std::floor(y), std::floor(y) + 1}) {
    for (const double column : {std::floor(x), std::floor(x) + 1}) {
      const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
      if (!(weight > 0) || std::min(column, row) < 0 || column >= width || row >= height) continue;
      const std::size_t there = static_cast<std::size_t>(row) * before.samples.width + static_cast<std::size_t>(column);
      const float visibility = before.visibility[there];
      if (before.samples.triangle[there] == visibility::ViewSamples::kBackground || std::isnan(visibility)) continue;
      // Ratio of the depths of this surface's plane and of the surface shown, at that pixel of the previous picture.
      const glm::dvec3 seen = glm::dvec3(before.samples.p[there]) - camera.eye;
      const double on_plane = glm::dot(n, d) / glm::dot(n, seen);
      if (!(std::abs(on_plane - 1) < kSameDepth)) continue;
      sum += weight * static_cast<double>(visibility);
      weights += weight;
    }
  }
  return weights > 0 ? static_cast<float>(sum / weights) : kNone;
}

glm::dvec2 jitter_of(std::uint32_t frame) {
  if (frame == 0) return glm::dvec2(0);
  return glm::dvec2(mirrored(frame, 2), mirrored(frame, 3)) - 0.5;
}

std::unique_ptr<visibility::Method> with_history(std::unique_ptr<visibility::Method> method,
                                                 std::unique_ptr<glm::dvec2> jitter, const HistoryOptions& options) {
  return std::make_unique<History>(std::move(method), std::move(jitter), options);
}

}  // namespace penumbra::maps
