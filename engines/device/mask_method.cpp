// SPDX-License-Identifier: Apache-2.0
// Host of mask methods on the Vulkan device: runs their kernels over bands of a tile until all lists fit, and settles
// open light samples by exact predicates.

#include "engines/device/mask_method.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "engines/device/settle.comp.spv.hpp"
#include "visibility/masks/visible_share.hpp"

#include <algorithm>
#include <utility>

namespace penumbra::device {
namespace {

constexpr std::uint32_t kBlockRows = 8;  // a multiple of the heights of all kernels' blocks of pixels
constexpr std::uint32_t kFirstQuestions = 1U << 14;

}  // namespace

MaskMethod::MaskMethod(const render::Device& device, visibility::MethodDescription description,
                       std::uint64_t question_bytes)
    : device_(&device),
      others_bytes_(device.allocated_bytes()),
      description_(std::move(description)),
      settle_(device, {.name = "settle", .spirv = shaders::kSettleComp, .push_bytes = sizeof(std::uint32_t)}),
      commands_(device),
      view_(device),
      questions_(device, {"questions", sizeof(gpu::QuestionHead), question_bytes, kFirstQuestions}) {
  device.forget_peak();
}

void MaskMethod::prepare_mesh(const visibility::SceneFloats& scene) {
  scene_ = &scene;
  scale_ = visibility::device_scale(scene);
  tree_ = visibility::make_triangle_tree(scene);
  notes_ = note_triangles();
  triangles_.prepare(*device_, scene, tree_, scale_, notes_);
}

void MaskMethod::prepare_light(const visibility::Light& light) {
  visibility::check_light(description_, light);
  PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
  light_ = &light;
  counters_.clear();
  device_light_ = visibility::make_device_light(light, scale_);
  layout_ = prepare_casters();
}

void MaskMethod::prepare_view(const visibility::ViewSamples& samples) {
  PENUMBRA_ASSERT(light_ != nullptr, "prepare_light comes first: {} pixels", samples.size());
  samples_ = &samples;
  view_.prepare(samples, *scene_, *light_, scale_, notes_.tags);
  if (max_tile_rows() >= samples.height) view_.load({0, samples.height});
}

std::uint32_t MaskMethod::max_tile_rows() const {
  PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
  const std::uint64_t per_pixel =
      std::max<std::uint64_t>({4ULL * layout_.words, ViewUpload::kBytesPerPixel, bytes_per_pixel()});
  const render::Limits& limits = device_->limits();
  const std::uint64_t rows =
      std::min(limits.max_storage_buffer_range / (per_pixel * samples_->width),
               limits.max_texel_buffer_elements / (ViewUpload::kTexelsPerPixel * samples_->width));
  if (rows == 0) {
    throw ResourceError(
        "one row of {} pixels with {} light samples is more than this device's storage buffers can hold",
        samples_->width, light_->sample_count());
  }
  const auto whole = static_cast<std::uint32_t>(std::min<std::uint64_t>(rows, samples_->height));
  return whole >= kBlockRows && whole < samples_->height ? whole / kBlockRows * kBlockRows : whole;
}

void MaskMethod::evaluate(const visibility::Tile& tile) {
  tile_ = tile;
  view_.load(tile);
  render::grow(*device_, masks_, "masks", tile_pixels() * layout_.words * 4);
  render::grow(*device_, counts_, "visible light samples", tile_pixels() * 4);
  // Bands of rows, divided in two if a band's lists would exceed the largest buffer.
  std::vector<visibility::Tile> bands{{0, tile.row_count}};
  while (!bands.empty()) {
    const visibility::Tile band = bands.back();
    bands.pop_back();
    if (run_whole(band)) continue;
    if (band.row_count < 2 * kBlockRows) {
      throw ResourceError("{}: the lists of {} rows of pixels are more than this device's storage buffers can hold",
                          description_.name, band.row_count);
    }
    const std::uint32_t half = band.row_count / 2 / kBlockRows * kBlockRows;
    bands.push_back({band.first_row + half, band.row_count - half});
    bands.push_back({band.first_row, half});
    ++counters_["splitBands"];
  }
  finish();
}

bool MaskMethod::run_whole(const visibility::Tile& band) {
  for (;;) {
    if (!questions_.is_possible()) {
      questions_.shrink();
      return false;
    }
    questions_.clear(commands_);
    const Attempt attempt = run(band);
    if (attempt == Attempt::too_large) return false;
    if (attempt == Attempt::again) continue;
    submit();
    const auto head = questions_.head<gpu::QuestionHead>();
    if (head.cut_off != 0) {
      shorten_loops();
      ++counters_["loopRetries"];
    } else if (!questions_.holds(head.count)) {
      ++counters_["listRetries"];
    } else {
      if (head.count > 0) answer(open_bits(head.count));
      count(counters_);
      return true;
    }
  }
}

void MaskMethod::shorten_loops() {
  PENUMBRA_ASSERT(false, "{} has no loops to shorten", description_.name);
}

void MaskMethod::answer(std::span<const OpenBits> questions) {
  settle(decide(questions));
}

std::vector<gpu::MaskWord> MaskMethod::decide(std::span<const OpenBits> questions) {
  const std::size_t first_pixel = std::size_t{tile_.first_row} * samples_->width;
  return times_.add("exact predicates", [&] {
    return device::decide({{*scene_, tree_, *samples_, *light_}, layout_, first_pixel}, questions);
  });
}

void MaskMethod::settle(std::span<const gpu::MaskWord> words) {
  const std::size_t at_once = device_->limits().max_storage_buffer_range / sizeof(gpu::MaskWord);
  for (std::size_t first = 0; first < words.size(); first += at_once) {
    const auto part = words.subspan(first, std::min(at_once, words.size() - first));
    render::grow(*device_, decided_, "decided words", part.size_bytes());
    decided_->write(part);
    settle_.record(commands_, static_cast<std::uint32_t>(part.size()), {*masks_, *counts_, *decided_},
                   (part.size() + 63) / 64);
    submit();
  }
}

void MaskMethod::read_masks(std::span<std::uint32_t> masks) {
  const std::size_t pixels = masks.size() / light_->words_per_mask();
  std::vector<std::uint32_t> counts(pixels), of_kernels(pixels * layout_.words);
  counts_->read(std::span(counts));
  masks_->read(std::span(of_kernels));
  arrange(layout_, *light_, counts, of_kernels, masks);
}

void MaskMethod::read_visibility(std::span<float> visibility) {
  if (!light_->weights.empty()) {
    std::vector<std::uint32_t> masks(visibility.size() * light_->words_per_mask());
    read_masks(masks);
    visibility::visible_shares(*light_, masks, visibility);
    return;
  }
  std::vector<std::uint32_t> counts(visibility.size());
  counts_->read(std::span(counts));
  const auto all = static_cast<double>(light_->sample_count());
  std::transform(counts.begin(), counts.end(), visibility.begin(),
                 [&](std::uint32_t count) { return static_cast<float>(count / all); });
}

}  // namespace penumbra::device
