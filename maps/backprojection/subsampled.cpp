// SPDX-License-Identifier: Apache-2.0
// Computes V of some pixels, fewer where penumbrae are wide on the screen, and fills in the others by pull-push:
// Guennebaud, Barthe and Paulin 2007, "High-quality adaptive soft shadow mapping", as described in the course notes of
// Eisemann et al. (2009, section 5.2.3.5). The notes do not give the estimate of the width; here it comes from nodes of
// the kernel (penumbra_width.comp). Departure: V passes only between pixels of the same object.

#include "maps/backprojection/subsampled.hpp"

#include "base/assert.hpp"
#include "maps/backprojection/penumbra_width.hpp"
#include "maps/host/scene_space.hpp"
#include "visibility/receivers.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <utility>

namespace penumbra::maps {
namespace {

using visibility::ViewSamples;

/// Pixel of a level of the pyramid, of one object: V, and the position in the picture that the pixel represents.
struct Node {
  double v = 0, x = 0, y = 0;
  bool known = false;
};
using Level = std::unordered_map<std::uint64_t, Node>;

constexpr std::uint64_t key_of(std::uint32_t object, std::uint32_t x, std::uint32_t y) {
  return std::uint64_t{object} << 40 | std::uint64_t{y} << 20 | x;
}

/// Object and pixel encoded in a key.
struct ObjectPixel {
  std::uint32_t object, x, y;
};
constexpr ObjectPixel pixel_of(std::uint64_t key) {
  constexpr std::uint64_t kAxis = (1u << 20) - 1;
  return {static_cast<std::uint32_t>(key >> 40), static_cast<std::uint32_t>(key & kAxis),
          static_cast<std::uint32_t>(key >> 20 & kAxis)};
}

Level pulled(const Level& fine) {
  Level coarse;
  for (const auto& [key, node] : fine) {
    const ObjectPixel at = pixel_of(key);
    coarse.try_emplace(key_of(at.object, at.x / 2, at.y / 2));
  }
  // Children in a fixed order: the order of the map must not affect the rounding of sums.
  for (auto& [key, node] : coarse) {
    const ObjectPixel at = pixel_of(key);
    double count = 0;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const auto child = fine.find(key_of(at.object, 2 * at.x + (k & 1), 2 * at.y + (k >> 1)));
      if (child == fine.end() || !child->second.known) continue;
      node.v += child->second.v;
      node.x += child->second.x;
      node.y += child->second.y;
      count += 1;
    }
    node.known = count > 0;
    if (!node.known) continue;
    node.v /= count;
    node.x /= count;
    node.y /= count;
  }
  return coarse;
}

/// Returns V at a node's position from the nodes of the coarser level around it, each `spacing` pixels wide, with tent
/// weights of this width, which are bilinear on a regular grid.
double between(const Level& coarse, const ObjectPixel& at, const Node& node, double spacing) {
  double sum = 0, weights = 0;
  for (std::int64_t dy = -1; dy <= 1; ++dy) {
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      const std::int64_t x = at.x / 2 + dx, y = at.y / 2 + dy;
      if (x < 0 || y < 0) continue;
      const auto found = coarse.find(key_of(at.object, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
      if (found == coarse.end()) continue;
      const double weight = std::max(0.0, 1 - std::abs(found->second.x - node.x) / spacing) *
                            std::max(0.0, 1 - std::abs(found->second.y - node.y) / spacing);
      sum += weight * found->second.v;
      weights += weight;
    }
  }
  return sum / weights;  // weights > 0: the node's own parent is in the same square, less than `spacing` away
}

class Subsampled final : public visibility::Method, public SeesScene {
 public:
  /// If `widths` is null, pixels are chosen by a grid.
  Subsampled(std::unique_ptr<visibility::Method> method, std::unique_ptr<visibility::Method> widths, std::uint32_t step)
      : method_(std::move(method)), widths_(std::move(widths)), step_(step), description_(method_->description()) {
    description_.output = visibility::Output::scalar;  // filled-in pixels have no masks
  }

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }
  void see_through(const SceneSpace& space) override {
    if (auto* sees = dynamic_cast<SeesScene*>(method_.get())) sees->see_through(space);
  }
  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    method_->prepare_mesh(scene);
    if (widths_) widths_->prepare_mesh(scene);
  }
  void prepare_light(const visibility::Light& light) override {
    light_ = &light;
    method_->prepare_light(light);
    if (widths_) widths_->prepare_light(light);
    whole_.clear();
  }
  void prepare_view(const ViewSamples& samples) override;
  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    return samples_ == nullptr ? 1 : std::max(samples_->height, 1u);
  }
  void evaluate(const visibility::Tile& tile) override;
  void read_visibility(std::span<float> visibility) override;

  std::vector<visibility::PassTime> take_pass_times() override { return method_->take_pass_times(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override {
    auto counters = method_->counters();
    counters["pixelsComputed"] = computed_.size();
    return counters;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return method_->memory_bytes() + (widths_ ? widths_->memory_bytes() : 0);
  }

 private:
  /// Returns each pixel's step; an empty list if all have step_.
  [[nodiscard]] std::vector<std::uint32_t> steps();
  /// Makes the list of pixels that the method evaluates.
  void choose_pixels();
  /// Adds a pixel to the list of pixels that the method evaluates.
  void choose(std::uint32_t pixel);

  std::unique_ptr<visibility::Method> method_, widths_;
  std::uint32_t step_;
  visibility::MethodDescription description_;
  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const ViewSamples* samples_ = nullptr;
  ViewSamples few_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> computed_;  ///< pixel, and its index in few_
  std::vector<float> whole_;                                       ///< V of all pixels
  visibility::Tile tile_{};
};

void Subsampled::choose(std::uint32_t pixel) {
  if (visibility::is_receiver(*scene_, *light_, *samples_, pixel)) {
    computed_.emplace_back(pixel, static_cast<std::uint32_t>(few_.triangle.size()));
  }
  few_.triangle.push_back(samples_->triangle[pixel]);
  few_.p.push_back(samples_->p[pixel]);
  few_.n.push_back(samples_->n[pixel]);
  few_.depth.push_back(samples_->depth[pixel]);
  few_.facing.push_back(samples_->facing[pixel]);
}

/// Returns the method's V of all pixels in `samples`.
std::vector<float> answers(visibility::Method& method, const ViewSamples& samples) {
  std::vector<float> values(samples.size());
  for (std::uint32_t row = 0; row < samples.height;) {
    const std::uint32_t rows = std::min(method.max_tile_rows(), samples.height - row);
    method.evaluate({row, rows});
    method.read_visibility(
        std::span(values).subspan(std::size_t{row} * samples.width, std::size_t{rows} * samples.width));
    row += rows;
  }
  return values;
}

std::vector<std::uint32_t> Subsampled::steps() {
  if (!widths_) return {};
  const std::vector<float> widths = answers(*widths_, *samples_);
  // size of a pixel at distance 1
  const double unit = 2 * samples_->camera.tan_half_fov / std::max(samples_->height, 1U);
  std::vector<std::uint32_t> steps(widths.size(), 1);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (samples_->triangle[i] == ViewSamples::kBackground || std::isinf(widths[i])) continue;
    // On an oblique surface, penumbrae appear narrower.
    const glm::vec3 direction = samples_->eye - samples_->p[i];
    const double slant =
        static_cast<double>(std::abs(glm::dot(samples_->n[i], direction)) / std::max(glm::length(direction), 1e-30F));
    const double pixels = static_cast<double>(widths[i]) * slant / (unit * static_cast<double>(samples_->depth[i]));
    while (2 * steps[i] <= step_ && 2 * steps[i] * kPixelsAcross <= pixels) steps[i] *= 2;
  }
  return steps;
}

void Subsampled::prepare_view(const ViewSamples& samples) {
  PENUMBRA_ASSERT(scene_ != nullptr, "{}: prepare_view before prepare_mesh", description().name);
  samples_ = &samples;
  whole_.clear();
  if (widths_) {
    widths_->prepare_view(samples);
  } else {
    choose_pixels();
  }
}

void Subsampled::choose_pixels() {
  const ViewSamples& samples = *samples_;
  const std::vector<std::uint32_t> steps = this->steps();
  computed_.clear();
  few_ = {};
  few_.camera = samples.camera;
  few_.eye = samples.eye;
  few_.width = steps.empty() ? (samples.width + step_ - 1) / step_ : samples.width;
  // Pixels of the grid stay neighbours; pixels of objects missed by the grid follow, row by row.
  std::set<std::uint32_t> shown;
  const auto object_of = [&](std::uint32_t pixel) {
    return scene_->object[static_cast<std::size_t>(samples.triangle[pixel])];
  };
  const std::uint32_t every = steps.empty() ? step_ : 1;
  for (std::uint32_t y = 0; y < samples.height; y += every) {
    for (std::uint32_t x = 0; x < samples.width; x += every) {
      const std::uint32_t pixel = y * samples.width + x;
      if (!steps.empty() && (x % steps[pixel] != 0 || y % steps[pixel] != 0)) continue;
      choose(pixel);
      if (visibility::is_receiver(*scene_, *light_, samples, pixel)) shown.insert(object_of(pixel));
    }
  }
  for (std::uint32_t pixel = 0; pixel < samples.size(); ++pixel) {
    if (visibility::is_receiver(*scene_, *light_, samples, pixel) && !shown.contains(object_of(pixel))) choose(pixel);
  }
  while (few_.width > 0 && few_.triangle.size() % few_.width != 0) {
    few_.triangle.push_back(ViewSamples::kBackground);
    few_.p.emplace_back(0);
    few_.n.emplace_back(0);
    few_.depth.push_back(0);
    few_.facing.push_back(0);
  }
  few_.height = few_.width == 0 ? 0 : static_cast<std::uint32_t>(few_.triangle.size() / few_.width);
  method_->prepare_view(few_);
}

void Subsampled::evaluate(const visibility::Tile& tile) {
  PENUMBRA_ASSERT(samples_ != nullptr, "{}: evaluate before prepare_view", description().name);
  tile_ = tile;
  // Pixels are filled in from the whole picture: only the first tile of a picture evaluates it.
  if (!whole_.empty() && tile.first_row > 0) return;
  if (widths_) choose_pixels();
  const std::vector<float> few = answers(*method_, few_);
  std::vector<KnownPixel> pixels(samples_->size());
  for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
    if (!visibility::is_receiver(*scene_, *light_, *samples_, pixel)) continue;
    pixels[pixel].object = scene_->object[static_cast<std::size_t>(samples_->triangle[pixel])];
  }
  for (const auto& [pixel, at] : computed_) {
    pixels[pixel].known = true;
    pixels[pixel].v = few[at];
  }
  fill_in(pixels, samples_->width);
  whole_.resize(pixels.size());
  std::ranges::transform(pixels, whole_.begin(), &KnownPixel::v);
}

void Subsampled::read_visibility(std::span<float> visibility) {
  const std::size_t first = std::size_t{tile_.first_row} * (samples_ == nullptr ? 0 : samples_->width);
  PENUMBRA_ASSERT(first + visibility.size() <= whole_.size(), "{} values from pixel {} on of {}", visibility.size(),
                  first, whole_.size());
  std::ranges::copy(std::span(whole_).subspan(first, visibility.size()), visibility.begin());
}

}  // namespace

void fill_in(std::span<KnownPixel> pixels, std::uint32_t width) {
  std::vector<Level> levels(1);
  std::size_t known = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const KnownPixel& pixel = pixels[i];
    if (pixel.object == KnownPixel::kNothing) continue;
    known += pixel.known ? 1 : 0;
    const auto x = static_cast<std::uint32_t>(i % width), y = static_cast<std::uint32_t>(i / width);
    levels[0].emplace(key_of(pixel.object, x, y),
                      Node{static_cast<double>(pixel.v), static_cast<double>(x), static_cast<double>(y), pixel.known});
  }
  if (known == 0 || known == levels[0].size()) return;
  // Levels are built up to the one on which each object is one pixel.
  while (levels.back().size() > 1 && levels.size() < 21) levels.push_back(pulled(levels.back()));
  for (std::size_t level = levels.size() - 1; level-- > 0;) {
    const double side = std::ldexp(1.0, static_cast<int>(level));
    for (auto& [key, node] : levels[level]) {
      if (node.known) continue;
      const ObjectPixel at = pixel_of(key);
      // An unknown node represents the first pixel of its square, as the grid's own pixels do.
      node.x = side * at.x;
      node.y = side * at.y;
      node.v = between(levels[level + 1], at, node, 2 * side);
    }
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels[i].object == KnownPixel::kNothing || pixels[i].known) continue;
    const auto found = levels[0].find(
        key_of(pixels[i].object, static_cast<std::uint32_t>(i % width), static_cast<std::uint32_t>(i / width)));
    pixels[i].v = static_cast<float>(std::clamp(found->second.v, 0.0, 1.0));
  }
}

std::unique_ptr<visibility::Method> subsampled(const render::Device& device, std::unique_ptr<visibility::Method> method,
                                               const visibility::ParsedOptions& parsed,
                                               const visibility::MethodOptions& options) {
  const std::uint32_t step = parsed[kSubsample];
  if (step == 1) return method;
  auto widths = parsed[kSubsampleBy] == SubsampleBy::penumbra ? make_penumbra_widths(device, options) : nullptr;
  return std::make_unique<Subsampled>(std::move(method), std::move(widths), step);
}

}  // namespace penumbra::maps
