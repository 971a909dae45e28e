// SPDX-License-Identifier: Apache-2.0
// Domes for methods that support rectangles infinitely far away: evaluates the faces of a cube one after the other.

#include "visibility/masks/dome_method.hpp"

#include "base/assert.hpp"
#include "visibility/dome_faces.hpp"
#include "visibility/dome_picture.hpp"
#include "visibility/masks/visible_share.hpp"
#include "visibility/skies/sky.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

namespace penumbra::visibility {
namespace {

class DomeMethod final : public Method {
 public:
  explicit DomeMethod(std::unique_ptr<Method> method) : method_(std::move(method)) {}

  [[nodiscard]] const MethodDescription& description() const override { return method_->description(); }
  void want_pixels(std::span<const std::uint32_t> pixels) override { method_->want_pixels(pixels); }
  void want_form_factors(bool wanted) override { method_->want_form_factors(wants_form_factors_ = wanted); }
  void expect_frames() override { method_->expect_frames(); }
  void prepare_mesh(const SceneFloats& scene) override { method_->prepare_mesh(scene); }
  void prepare_light(const Light& light) override;
  void prepare_view(const ViewSamples& samples) override {
    samples_ = &samples;
    method_->prepare_view(samples);
  }
  [[nodiscard]] std::uint32_t max_tile_rows() const override;
  void evaluate(const Tile& tile) override;
  void read_masks(std::span<std::uint32_t> masks) override;
  void read_form_factors(std::span<glm::dvec3> form_factors) override;
  void read_visibility(std::span<float> visibility) override;
  std::vector<PassTime> take_pass_times() override { return method_->take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    return dome_ != nullptr ? counters_ : method_->counters();
  }
  std::map<std::string, std::uint64_t> take_mesh_counters() override { return method_->take_mesh_counters(); }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return method_->memory_bytes() + masks_.capacity() * sizeof(std::uint32_t) +
           form_factors_.capacity() * sizeof(glm::dvec3);
  }

 private:
  [[nodiscard]] std::span<const glm::vec3> normals() const {
    return std::span(samples_->n).subspan(std::size_t{tile_.first_row} * samples_->width, pixels_);
  }
  void add_masks(const Light& face, std::size_t first_pixel, std::size_t count);
  void add_form_factors(const Light& face, std::size_t first_pixel, std::size_t count);
  [[nodiscard]] std::vector<double> whole_form_factors() const;

  std::unique_ptr<Method> method_;
  bool wants_form_factors_ = false;
  const Light* dome_ = nullptr;  // null: the light is of another kind
  std::vector<Light> faces_;
  const ViewSamples* samples_ = nullptr;
  Tile tile_;
  std::size_t pixels_ = 0;  // pixels of the tile
  std::vector<std::uint32_t> masks_, part_;
  std::vector<std::uint8_t> sees_all_;  // for each pixel, whether it sees all of every face so far
  std::vector<glm::dvec3> form_factors_;
  std::vector<float> part_visibility_;
  std::vector<glm::dvec3> part_form_factors_;
  std::map<std::string, std::uint64_t> counters_;
};

void DomeMethod::prepare_light(const Light& light) {
  check_light(description(), light);
  dome_ = light.dome ? &light : nullptr;
  faces_.clear();
  counters_.clear();
  method_->want_form_factors(wants_form_factors_ || dome_ != nullptr);
  if (dome_ != nullptr && dome_->dome->sky && description().gives_area()) dome_->dome->sky->prepare();
  if (dome_ == nullptr) return method_->prepare_light(light);
  faces_ = light_faces(light, description().gives_area());
  std::erase_if(faces_, [](const Light& face) { return face.points.empty(); });
  method_->prepare_light(faces_.front());
}

std::uint32_t DomeMethod::max_tile_rows() const {
  if (dome_ == nullptr || description().gives_area()) return method_->max_tile_rows();
  PENUMBRA_ASSERT(samples_ != nullptr, "prepare_view comes first");
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  const std::size_t row_bytes = std::size_t{4} * samples_->width * dome_->words_per_mask();
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(kMostBytes / row_bytes, 1, samples_->height));
}

void DomeMethod::evaluate(const Tile& tile) {
  if (dome_ == nullptr) return method_->evaluate(tile);
  tile_ = tile;
  pixels_ = std::size_t{tile.row_count} * samples_->width;
  const bool areas = description().gives_area();
  masks_.assign(areas ? 0 : pixels_ * dome_->words_per_mask(), 0U);
  form_factors_.assign(areas ? pixels_ : 0, glm::dvec3(0));
  sees_all_.assign(areas ? pixels_ : 0, 1);
  for (const Light& face : faces_) {
    method_->prepare_light(face);
    for (std::uint32_t row = 0; row < tile.row_count;) {
      const Tile band{tile.first_row + row, std::min(std::max(method_->max_tile_rows(), 1U), tile.row_count - row)};
      method_->evaluate(band);
      const std::size_t first = std::size_t{row} * samples_->width,
                        count = std::size_t{band.row_count} * samples_->width;
      if (areas)
        add_form_factors(face, first, count);
      else
        add_masks(face, first, count);
      row += band.row_count;
    }
    for (const auto& [name, count] : method_->counters()) counters_[name] += count;
  }
}

/// Copies a face's bits to the dome's light samples.
void DomeMethod::add_masks(const Light& face, std::size_t first_pixel, std::size_t count) {
  const std::size_t own = face.words_per_mask(), words = dome_->words_per_mask();
  const std::uint32_t at = dome_->dome->first[static_cast<std::size_t>(face.dome->face)], shift = at % 32;
  part_.resize(count * own);
  method_->read_masks(part_);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      std::uint32_t* const to = &masks_[(first_pixel + i) * words + at / 32];
      for (std::size_t word = 0; word < own; ++word) {
        const std::uint32_t bits = part_[i * own + word];
        to[word] |= bits << shift;
        if (const std::uint32_t over = shift == 0 ? 0 : bits >> (32 - shift); over != 0) to[word + 1] |= over;
      }
    }
  });
}

void DomeMethod::add_form_factors(const Light& face, std::size_t first_pixel, std::size_t count) {
  part_visibility_.resize(count);
  part_form_factors_.resize(count);
  method_->read_visibility(part_visibility_);
  method_->read_form_factors(part_form_factors_);
  const Sky* const sky = dome_->dome->sky.get();
  const std::span<const glm::vec3> n = normals();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = first_pixel + i;
    glm::dvec3 seen = part_form_factors_[i];
    if (part_visibility_[i] != 1)
      sees_all_[pixel] = 0;
    else if (sky != nullptr && seen != glm::dvec3(0))  // 0: background
      seen = sky->form_factor(sky->of_face(static_cast<std::size_t>(face.dome->face)),
                              glm::normalize(glm::dvec3(n[pixel])));
    // NaN: the pixel is not wanted
    if (part_visibility_[i] != 0) form_factors_[pixel] += glm::max(seen, glm::dvec3(0));
  }
}

/// Returns for each pixel of the tile the dome's form factor without occluders; for a picture its luminance, or 0 where
/// that is within rounding. Computes it once for all pixels with the same normal.
std::vector<double> DomeMethod::whole_form_factors() const {
  const std::span<const glm::vec3> n = normals();
  std::vector<double> whole(n.size());
  const Sky* const sky = dome_->dome->sky.get();
  if (sky == nullptr) {
    std::ranges::transform(n, whole.begin(), [&](const glm::vec3& normal) {
      return dome_form_factor(*dome_, glm::normalize(glm::dvec3(normal)));
    });
    return whole;
  }
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(n[a].x, n[a].y, n[a].z) < std::tie(n[b].x, n[b].y, n[b].z);
  };
  std::vector<std::uint32_t> order(n.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), less);
  std::vector<std::size_t> first;  // position in `order` of the first pixel with each normal
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || less(order[i - 1], order[i])) first.push_back(i);
  }
  first.push_back(order.size());
  tbb::parallel_for(std::size_t{0}, first.size() - 1, [&](std::size_t group) {
    const glm::dvec3 normal(n[order[first[group]]]);
    if (!(glm::length(normal) > 0)) return;  // background
    const glm::dvec3 unit = glm::normalize(normal);
    const double value = luminance_of(sky->form_factor(sky->above(unit), unit));
    for (std::size_t i = first[group]; i < first[group + 1]; ++i) whole[order[i]] = value > sky->rounding() ? value : 0;
  });
  return whole;
}

void DomeMethod::read_masks(std::span<std::uint32_t> masks) {
  if (dome_ == nullptr) return method_->read_masks(masks);
  PENUMBRA_ASSERT(masks.size() == masks_.size(), "{} words asked for, {} evaluated", masks.size(), masks_.size());
  std::ranges::copy(masks_, masks.begin());
}

void DomeMethod::read_form_factors(std::span<glm::dvec3> form_factors) {
  if (dome_ == nullptr) return method_->read_form_factors(form_factors);
  std::ranges::copy(form_factors_, form_factors.begin());
}

void DomeMethod::read_visibility(std::span<float> visibility) {
  if (dome_ == nullptr) return method_->read_visibility(visibility);
  if (!description().gives_area()) return visible_shares(*dome_, masks_, normals(), visibility);
  const bool has_sky = dome_->dome->sky != nullptr;
  const std::vector<double> wholes = whole_form_factors();
  const std::span<const std::int32_t> triangles =
      std::span(samples_->triangle).subspan(std::size_t{tile_.first_row} * samples_->width, pixels_);
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    const double whole = wholes[i], seen = has_sky ? luminance_of(form_factors_[i]) : form_factors_[i].x;
    if (sees_all_[i] != 0 && (!has_sky || whole > 0 || triangles[i] == ViewSamples::kBackground)) {
      visibility[i] = 1;
      continue;
    }
    if (std::isnan(seen))
      visibility[i] = static_cast<float>(seen);
    else
      visibility[i] = seen > 0 && whole > 0 ? static_cast<float>(std::min(seen / whole, 1.0)) : 0.0F;
  }
}

}  // namespace

std::unique_ptr<Method> with_domes(std::unique_ptr<Method> method) {
  return std::make_unique<DomeMethod>(std::move(method));
}

}  // namespace penumbra::visibility
