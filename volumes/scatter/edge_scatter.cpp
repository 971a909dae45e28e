// Depth complexity by silhouette edges (Laine et al. 2005), for any soup by signed multiplicities (Bergeron 1986), on a
// grid of light samples: docs/edge-scatter.md.

#include "volumes/scatter/edge_scatter.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "engines/engine_choice.hpp"
#include "render/compute_pass.hpp"
#include "visibility/tree_texels.hpp"
#include "visibility/light_frame.hpp"
#include "visibility/visible_share.hpp"
#include "volumes/edges/edge_lists.hpp"
#include "volumes/scatter/vectors/edge_scatter_native.hpp"
#include "volumes/edges/edge_scatter.shared.h"
#include "volumes/scatter/row_judge.hpp"
#include "volumes/scatter/scatter_edges.comp.spv.hpp"
#include "volumes/edges/settle_rows.comp.spv.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

constexpr std::uint32_t kBlock = 8;           // pixels, as in edge_scatter.glsl
constexpr std::uint32_t kMostBandWords = 16;  // 64 light rows: what a question can name

constexpr visibility::ChoiceOption kExactRows{
    "rows",
    {{"samples", false}, {"exact", true}},
    false,
    "exact: V of the whole light, without light samples, on the processor; no masks"};

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::exact,
          visibility::reason_with("signed multiplicities hold for any soup, and every pair is decided exactly", mesh,
                                  {{mesh.boundary_loops, "open boundaries, where light passes as it should"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast nothing"}})};
}

class EdgeScatter final : public visibility::Method {
 public:
  explicit EdgeScatter(const render::Device& device)
      : description_(edge_scatter_description()),
        device_(&device),
        edges_(device, description_.name),
        settle_(device,
                {.name = "settle rows", .spirv = shaders::kSettleRowsComp, .push_bytes = sizeof(std::uint32_t)}),
        commands_(device) {}

  [[nodiscard]] const visibility::MethodDescription& description() const override { return description_; }

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    scene_ = &scene;
    edges_.prepare_mesh(scene);
  }

  void prepare_light(const visibility::Light& light) override {
    visibility::check_light(description_, light);
    PENUMBRA_ASSERT(scene_ != nullptr, "prepare_mesh comes first: {}", light.name);
    light_ = &light;
    counters_.clear();
    question_retries_ = 0;
    const visibility::LightFrame frame = visibility::make_light_frame(light, edges_.scale());
    PENUMBRA_ASSERT(frame.rows, "light {} has no rows that a step describes", light.name);
    shift_step_ = frame.shift_step;
    choose_band();
    edges_.prepare_light(light, frame);
  }

  void prepare_view(const visibility::ViewSamples& samples) override {
    samples_ = &samples;
    edges_.prepare_view(samples);
    if (max_tile_rows() >= samples.height) edges_.load({0, samples.height});
  }

  [[nodiscard]] std::uint32_t max_tile_rows() const override {
    PENUMBRA_ASSERT(samples_ != nullptr && light_ != nullptr, "prepare_light and prepare_view come first");
    const std::uint64_t per_pixel = std::max<std::uint64_t>(4ULL * words_per_mask(), device::ViewUpload::kBytesPerPixel);
    const std::uint64_t rows = device_->limits().max_storage_buffer_range / (per_pixel * samples_->width);
    if (rows == 0) {
      throw ResourceError(
          "one row of {} pixels with {} light samples is more than this device's storage buffers can hold",
          samples_->width, light_->sample_count());
    }
    const auto whole = static_cast<std::uint32_t>(std::min<std::uint64_t>(rows, samples_->height));
    return whole >= kBlock && whole < samples_->height ? whole / kBlock * kBlock : whole;
  }

  void evaluate(const visibility::Tile& tile) override {
    tile_ = tile;
    edges_.load(tile);
    const std::uint64_t pixels = std::uint64_t{tile.row_count} * samples_->width;
    render::grow(*device_, masks_, "masks", pixels * words_per_mask() * 4);
    render::grow(*device_, visible_, "visible light samples", pixels * 4);
    while (!try_tile()) ++question_retries_;
    if (edges_.retries() + question_retries_ > 0) counters_["listRetries"] = edges_.retries() + question_retries_;
  }

  void read_masks(std::span<std::uint32_t> masks) override {
    const std::uint32_t words = light_->words_per_mask(), own = words_per_mask(), columns = light_->columns;
    const std::size_t pixels = masks.size() / words;
    std::vector<std::uint32_t> blocks_of_bits(pixels * own), counts(pixels);
    masks_->read(std::span(blocks_of_bits));
    visible_->read(std::span(counts));
    std::fill(masks.begin(), masks.end(), 0U);
    const std::uint32_t count = light_->sample_count(), row_words = (light_->rows + 3) / 4;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const auto mask = masks.subspan(pixel * words, words);
      if (counts[pixel] == 0) continue;
      for (std::uint32_t j = 0; j < count; ++j) {
        const std::uint32_t row = j / columns, column = j % columns;
        const std::uint32_t word = column / 8 * row_words + row / 4, bit = row % 4 * 8 + column % 8;
        const bool visible = counts[pixel] == count || (blocks_of_bits[pixel * own + word] >> bit & 1U) != 0;
        mask[j / 32] |= (visible ? 1U : 0U) << (j % 32);
      }
    }
  }

  void read_visibility(std::span<float> visibility) override {
    if (!light_->weights.empty()) {
      std::vector<std::uint32_t> masks(visibility.size() * light_->words_per_mask());
      read_masks(masks);
      visibility::visible_shares(*light_, masks, visibility);
      return;
    }
    std::vector<std::uint32_t> counts(visibility.size());
    visible_->read(std::span(counts));
    const auto all = static_cast<double>(light_->sample_count());
    std::transform(counts.begin(), counts.end(), visibility.begin(),
                   [&](std::uint32_t count) { return static_cast<float>(count / all); });
  }

  std::vector<visibility::PassTime> take_pass_times() override { return times_.take(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return device_->peak_bytes(); }

 private:
  /// As many light rows at a time as the histograms of a subgroup leave room for.
  void choose_band() {
    const std::uint32_t lanes = device_->limits().subgroup_size;
    const std::uint32_t room = device_->limits().max_shared_memory / (4 * lanes * light_->columns);
    if (room == 0) {
      throw InputError(
          "light \"{}\": edge-scatter handles rows of up to {} light samples on {}; this has {}; use view-sample",
          light_->name, device_->limits().max_shared_memory / (lanes * 4), device_->info().name, light_->columns);
    }
    band_words_ = std::min({room, kMostBandWords, (light_->rows + 3) / 4});
    const std::uint32_t block_width = lanes >= 32 ? 8 : 4;
    const std::vector<std::uint32_t> constants{lanes,           lanes,       block_width,
                                               light_->columns, band_words_, light_->columns * band_words_};
    if (!scatter_ || constants != constants_) {
      scatter_.emplace(*device_, render::ComputePassOptions{.name = "scatter edges",
                                                            .spirv = shaders::kScatterEdgesComp,
                                                            .push_bytes = sizeof(gpu::ScatterPush),
                                                            .constants = constants,
                                                            .full_subgroups = true});
      constants_ = constants;
    }
  }

  [[nodiscard]] std::uint32_t words_per_mask() const { return (light_->columns + 7) / 8 * ((light_->rows + 3) / 4); }
  [[nodiscard]] std::uint64_t blocks() const {
    return std::uint64_t{(samples_->width + kBlock - 1) / kBlock} * ((tile_.row_count + kBlock - 1) / kBlock);
  }

  /// False when the list of questions was too short; it has grown then.
  bool try_tile() {
    render::grow(*device_, questions_, "open rows", std::uint64_t{question_capacity_} * sizeof(gpu::RowQuestion));
    commands_.fill(*visible_, 0);
    gpu::ScatterPush push{};
    push.rows = light_->rows;
    push.columns = light_->columns;
    push.shift_step = shift_step_;
    push.question_capacity = question_capacity_;
    std::uint32_t questions = 0;
    for (const float side : {1.0F, -1.0F}) {
      if (side < 0 && !light_->two_sided) continue;
      counters_["listWords"] += edges_.find(commands_, push, side, questions);
      times_.add(edges_.times());
      const std::uint32_t lanes = device_->limits().subgroup_size,
                          bands = (light_->rows + 4 * band_words_ - 1) / (4 * band_words_);
      scatter_->record(commands_, push,
                       {edges_.view(), edges_.heads(), edges_.lists(), edges_.slots(side, 0), edges_.slots(side, 1),
                        edges_.slots(side, 2), edges_.slots(side, 3), edges_.slots(side, 4), edges_.slots(side, 5),
                        edges_.triangle_corners(0), edges_.triangle_corners(1), edges_.triangle_corners(2), *masks_,
                        *visible_, *questions_},
                       blocks() * (kBlock * kBlock / lanes) * bands);
      times_.add(commands_.submit());
      questions = edges_.question_count();
      if (questions > question_capacity_) {
        question_capacity_ = questions + questions / 8;
        return false;
      }
    }
    answer(questions);
    return true;
  }

  void answer(std::uint32_t count) {
    if (count == 0) return;
    std::vector<gpu::RowQuestion> questions(count);
    questions_->read(std::span(questions));
    const std::vector<gpu::MaskWord> words = times_.add("exact predicates", [&] {
      return judge_rows({*scene_, edges_.tree(), *samples_, *light_, std::size_t{tile_.first_row} * samples_->width},
                        questions);
    });
    counters_["openPixels"] += count;
    for (const gpu::RowQuestion& question : questions) {
      counters_["openRows"] += static_cast<std::uint64_t>(std::popcount(question.low) + std::popcount(question.high));
    }
    const std::size_t at_once = device_->limits().max_storage_buffer_range / sizeof(gpu::MaskWord);
    for (std::size_t first = 0; first < words.size(); first += at_once) {
      const auto part = std::span(words).subspan(first, std::min(at_once, words.size() - first));
      render::grow(*device_, decided_, "decided rows", part.size_bytes());
      decided_->write(part);
      settle_.record(commands_, static_cast<std::uint32_t>(part.size()), {*masks_, *visible_, *decided_},
                     (part.size() + 63) / 64);
      times_.add(commands_.submit());
    }
  }

  visibility::MethodDescription description_;
  const render::Device* device_;
  EdgeLists edges_;
  render::ComputePass settle_;
  std::optional<render::ComputePass> scatter_;
  std::vector<std::uint32_t> constants_;
  render::Commands commands_;

  const visibility::SceneFloats* scene_ = nullptr;
  const visibility::Light* light_ = nullptr;
  const visibility::ViewSamples* samples_ = nullptr;
  visibility::Tile tile_;
  std::uint32_t band_words_ = 1, shift_step_ = 0;
  std::unique_ptr<render::Buffer> masks_, visible_, questions_, decided_;
  std::uint32_t question_capacity_ = 1U << 14;  // grows
  std::uint64_t question_retries_ = 0;

  visibility::PassTimes times_;
  std::map<std::string, std::uint64_t> counters_;
};

visibility::MethodDescription describe() {
  return {.name = "edge-scatter",
          .family = visibility::Family::geometry,
          .paper = "ours; after Laine et al. 2005 and Bergeron 1986",
          .output = visibility::Output::mask,
          .exact_for = "every pair of view sample and light sample, for any triangle soup (rows of a rectangle light)",
          .lights = {visibility::LightKind::rectangle},
          .any_pattern = false,
          .options = {engines::kEngine.description(), kExactRows.description()},
          .verdict_on = verdict_on};
}

}  // namespace

visibility::MethodDescription edge_scatter_description(const visibility::MethodOptions& given) {
  visibility::MethodDescription description = describe();
  const visibility::ParsedOptions options = visibility::parse_options(description, given);
  if (!options[kExactRows]) return description;
  if (options[engines::kEngine] == engines::Engine::vulkan) {
    throw UsageError("edge-scatter: rows=exact runs on the processor: leave engine=vulkan out");
  }
  description.output = visibility::Output::radiance;
  description.exact_for =
      "the visible share of a rectangle light, to float32, for any triangle soup; the beauty under constant radiance";
  description.textures = false;
  return description;
}

std::unique_ptr<visibility::Method> make_edge_scatter(const render::Device& device,
                                                      const visibility::MethodOptions& given) {
  visibility::MethodDescription description = edge_scatter_description(given);
  const visibility::ParsedOptions options = visibility::parse_options(description, given);
  const bool exact = options[kExactRows];
  if (exact || engines::runs_on_vectors(device, options[engines::kEngine])) {
    return make_native_edge_scatter(std::move(description), exact);
  }
  return std::make_unique<EdgeScatter>(device);
}

}  // namespace penumbra::volumes
