// SPDX-License-Identifier: Apache-2.0
// Depth complexity by silhouette edges (Laine et al. 2005), for any soup by signed multiplicities (Bergeron 1986), on a
// grid of light samples, or on arbitrary light samples in rows of similar height: docs/edge-scatter.md.

#include "volumes/scatter/methods.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "engines/engine_by_light.hpp"
#include "engines/engine_choice.hpp"
#include "render/compute_pass.hpp"
#include "render/features.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/masks/dome_method.hpp"
#include "visibility/method_repairs.hpp"
#include "volumes/edges/device/edge_method.hpp"
#include "volumes/edges/device/edge_scatter.shared.h"
#include "volumes/scatter/point_rows.hpp"
#include "volumes/scatter/scatter_edges.comp.spv.hpp"
#include "volumes/scatter/scatter_points.comp.spv.hpp"
#include "volumes/scatter/vectors/edge_scatter_vectors.hpp"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace penumbra::volumes {
namespace {

constexpr std::uint32_t kBlock = 8;  // in pixels, as in edge_scatter.glsl
/// Words for 64 light rows, as many as one RowQuestion (pairs left for the host to decide) can name.
constexpr std::uint32_t kMostBandWords = 16;

constexpr visibility::ChoiceOption kExactRows{
    "rows",
    {{"samples", false}, {"exact", true}},
    false,
    "exact: V of the whole light, without light samples, on the processor; no masks"};

visibility::MeshVerdict verdict_on(const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::exact,
          visibility::reason_with("signed multiplicities hold for any soup, and every pair is decided exactly", mesh,
                                  {{mesh.boundary_loops, "open boundaries, where light passes as it should"},
                                   {mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

bool is_planar_light(const visibility::Light& light) {
  return visibility::is_planar(light.kind);
}

static_assert(sizeof(gpu::PointQuestion) == sizeof(gpu::RowQuestion), "one list holds either");

class EdgeScatter final : public EdgeMethod {
 public:
  EdgeScatter(const render::Device& device, visibility::MethodDescription given)
      : EdgeMethod(device, std::move(given), sizeof(gpu::RowQuestion)) {
    render::require_features(device.info(), shaders::kScatterEdgesComp, "scatter edges");
  }

 private:
  /// Handles as many light rows at a time as fit into the histograms of a subgroup.
  device::MaskLayout prepare_kernel() override {
    const bool in_rows = device_light().rows;
    device::MaskLayout layout = in_rows ? arrange_rows() : arrange_points();
    const std::uint32_t lanes = device().limits().subgroup_size, block_width = lanes >= 32 ? 8 : lanes >= 8 ? 4 : 2;
    const std::uint32_t words = in_rows ? columns_ * band_rows_ / 4 : words_of_points(points_->fours, band_rows_);
    const std::vector<std::uint32_t> constants{
        lanes, lanes, block_width, in_rows ? columns_ : points_->fours, in_rows ? band_rows_ / 4 : band_rows_, words};
    if (!scatter_ || constants != constants_ || in_rows != passes_rows_) {
      scatter_.emplace(device(), render::ComputePassOptions{
                                     .name = "scatter edges",
                                     .spirv = in_rows ? std::span<const std::uint32_t>(shaders::kScatterEdgesComp)
                                                      : std::span<const std::uint32_t>(shaders::kScatterPointsComp),
                                     .push_bytes = sizeof(gpu::ScatterPush),
                                     .constants = constants,
                                     .full_subgroups = true});
      constants_ = constants;
      passes_rows_ = in_rows;
    }
    return layout;
  }

  /// Returns the words of shared memory available to a lane.
  [[nodiscard]] std::uint32_t room() const {
    return device().limits().max_shared_memory / (4 * device().limits().subgroup_size);
  }

  /// Arranges masks in words of 8 columns × 4 rows; the words of a column are contiguous.
  device::MaskLayout arrange_rows() {
    points_.reset();
    rows_ = light().rows;
    columns_ = light().columns;
    if (room() < columns_) {
      throw InputError(
          "light \"{}\": edge-scatter handles rows of up to {} light samples on {}; this light has rows of {}; use "
          "view-sample",
          light().name, room(), device().info().name, columns_);
    }
    band_rows_ = 4 * std::min({room() / columns_, kMostBandWords, row_words()});
    device::MaskLayout layout{.words = column_words() * row_words()};
    for (std::uint32_t bit = 0; bit < 32 * layout.words; ++bit) {
      const std::uint32_t word = bit / 32, row = word % row_words() * 4 + bit % 32 / 8,
                          column = word / row_words() * 8 + bit % 8;
      const bool is_sample = row < rows_ && column < columns_;
      layout.light_sample.push_back(is_sample ? row * columns_ + column : device::MaskLayout::kNone);
    }
    return layout;
  }
  [[nodiscard]] std::uint32_t row_words() const { return (rows_ + 3) / 4; }
  [[nodiscard]] std::uint32_t column_words() const { return (columns_ + 7) / 8; }

  /// Returns the number of words of a lane, counted as in scatter_points.comp; `rows` is a multiple of
  /// kPointRowsAtOnce.
  static std::uint32_t words_of_points(std::uint32_t fours, std::uint32_t rows) {
    return rows * fours + rows / 4 + rows * fours / 8;
  }

  /// Arranges masks with a bit for each slot, in bands of nearly equal height that fit into the available memory.
  device::MaskLayout arrange_points() {
    constexpr std::uint32_t kStep = gpu::kPointRowsAtOnce;
    constexpr std::uint32_t kWordsAFour = kStep + kStep / 8;  // words_of_points adds kStep / 4 to these
    PointRows points = make_point_rows(device_light().coordinates, (room() - kStep / 4) / kWordsAFour);
    rows_ = points.rows;
    columns_ = points.columns;
    const std::uint32_t steps = (rows_ + kStep - 1) / kStep, at_once = room() / words_of_points(points.fours, kStep);
    if (at_once == 0) {
      throw InputError(
          "light \"{}\": edge-scatter has no room on {} for {} light samples in one row; use fewer light samples, or "
          "view-sample",
          light().name, device().info().name, points.fours * gpu::kPointsAtOnce);
    }
    const std::uint32_t bands = (steps + at_once - 1) / at_once;
    band_rows_ = (steps + bands - 1) / bands * kStep;
    const std::uint32_t slots = bands * band_rows_ * points.fours * gpu::kPointsAtOnce;
    points.sample_of.resize(slots, PointRows::kNone);
    points.places.resize(slots / 2);  // the content of these rows is unused
    std::vector<glm::uvec2> words(slots / 32, glm::uvec2(0));
    std::vector<char> touched(light().sample_count(), 0);
    for (const std::uint32_t sample : edges().touch().samples) touched[sample] = 1;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      const std::uint32_t sample = points.sample_of[slot];
      if (sample == PointRows::kNone) continue;
      words[slot / 32].x |= 1U << (slot % 32);
      words[slot / 32].y |= touched[sample] != 0 ? 1U << (slot % 32) : 0U;
    }
    points_.emplace(Points{
        render::make_buffer<glm::vec4>(device(), "places of light samples", points.places),
        render::make_buffer<std::uint32_t>(device(), "starts in rows of light samples", points.starts),
        render::make_buffer<glm::uvec2>(device(), "slots of light samples", words), points.fours, std::move(words)});
    return {.words = slots / 32, .light_sample = std::move(points.sample_of)};
  }

  [[nodiscard]] gpu::ScatterPush make_push() const override {
    gpu::ScatterPush push{};
    push.rows = rows_;
    push.columns = columns_;
    push.shift_step = device_light().shift_step;
    return push;
  }

  void record(const gpu::ScatterPush& push, std::vector<render::BufferReference> inputs,
              const visibility::Tile& band) override {
    if (push.side > 0) {
      commands().fill(counts(), 0, std::uint64_t{4} * push.first_pixel, std::uint64_t{4} * band.row_count * push.width);
    }
    inputs.insert(inputs.end(), {masks(), counts(), questions().buffer()});
    if (points_) inputs.insert(inputs.end(), {points_->places, points_->starts, points_->slots});
    const std::uint64_t blocks =
        std::uint64_t{(push.width + kBlock - 1) / kBlock} * ((band.row_count + kBlock - 1) / kBlock);
    const std::uint32_t lanes = device().limits().subgroup_size, bands = (rows_ + band_rows_ - 1) / band_rows_;
    scatter_->record(commands(), std::as_bytes(std::span(&push, 1)), inputs,
                     blocks * (kBlock * kBlock / lanes) * bands);
  }

  std::vector<device::OpenBits> open_bits(std::uint32_t count) override {
    if (points_) return open_points(count);
    std::vector<gpu::RowQuestion> asked(count);
    questions().read(std::span(asked));
    open_pixels_ += count;
    std::vector<device::OpenBits> open;
    for (const gpu::RowQuestion& question : asked) add_open(question, open);
    return open;
  }

  /// Entries for single samples of a band are ignored if the whole band is left to the host: the list may be
  /// incomplete, as a driver may have ended the loop that asks them.
  std::vector<device::OpenBits> open_points(std::uint32_t count) {
    std::vector<gpu::PointQuestion> asked(count);
    questions().read(std::span(asked));
    using Band = std::pair<std::uint32_t, std::uint32_t>;
    std::vector<Band> whole;
    for (const gpu::PointQuestion& question : asked) {
      if ((question.pixel & device::gpu::kWholePixel) != 0)
        whole.emplace_back(question.pixel & ~device::gpu::kWholePixel, question.word);
    }
    std::ranges::sort(whole);
    const std::uint32_t band_words = band_rows_ * points_->fours / 8;
    std::vector<device::OpenBits> open;
    std::vector<std::uint32_t> pixels;
    for (const gpu::PointQuestion& question : asked) {
      const bool is_whole = (question.pixel & device::gpu::kWholePixel) != 0;
      pixels.push_back(question.pixel & ~device::gpu::kWholePixel);
      if (!is_whole && std::ranges::binary_search(whole, Band(pixels.back(), question.word / band_words * band_words)))
        continue;
      for (std::uint32_t word = question.word; word < question.word + question.words; ++word) {
        open.push_back({question.pixel, word, is_whole ? points_->words[word].x : question.bits});
        open_pairs_ += static_cast<std::uint64_t>(std::popcount(open.back().bits));
      }
    }
    std::ranges::sort(pixels);
    open_pixels_ += static_cast<std::uint64_t>(std::unique(pixels.begin(), pixels.end()) - pixels.begin());
    return open;
  }

  void add_open(const gpu::RowQuestion& question, std::vector<device::OpenBits>& open) {
    const std::uint64_t rows = question.low | std::uint64_t{question.high} << 32U;
    open_rows_ += static_cast<std::uint64_t>(std::popcount(rows));
    for (std::uint32_t row = question.first_row; row < std::min(question.first_row + 64, rows_); row += 4) {
      const auto four = static_cast<std::uint32_t>(rows >> (row - question.first_row) & 15U);
      if (four == 0) continue;
      std::uint32_t bits = 0;
      for (std::uint32_t r = 0; r < 4; ++r) bits |= (four >> r & 1U) * (0xffU << (8 * r));
      for (std::uint32_t word = row / 4; word < column_words() * row_words(); word += row_words()) {
        open.push_back({question.pixel, word, bits});
      }
    }
    for (const std::uint32_t sample : {question.sample_1, question.sample_2}) {
      if (sample == gpu::kNoSample) continue;
      const std::uint32_t row = sample / columns_, column = sample % columns_;
      if ((rows >> (row - question.first_row) & 1U) != 0) continue;  // already a question
      open.push_back({question.pixel, column / 8 * row_words() + row / 4, 1U << (row % 4 * 8 + column % 8)});
    }
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    EdgeMethod::count(counters);
    if (open_pixels_ == 0) return;
    counters["openPixels"] += std::exchange(open_pixels_, 0);
    if (points_) {
      counters["openPairs"] += std::exchange(open_pairs_, 0);
    } else {
      counters["openRows"] += std::exchange(open_rows_, 0);
    }
  }

  std::uint32_t rows_ = 0, columns_ = 0;  // of light samples, or of cells
  std::uint32_t band_rows_ = 1;
  struct Points {
    render::Buffer places, starts, slots;
    std::uint32_t fours;            ///< as in PointRows
    std::vector<glm::uvec2> words;  ///< content of the `slots` buffer
  };
  std::optional<Points> points_;  // for light samples that are not in rows of a rectangle
  std::optional<render::ComputePass> scatter_;
  std::vector<std::uint32_t> constants_;
  bool passes_rows_ = false;                                        // current mode of scatter_
  std::uint64_t open_pixels_ = 0, open_rows_ = 0, open_pairs_ = 0;  // counters
};

visibility::MethodDescription describe() {
  return {.name = "edge-scatter",
          .family = visibility::Family::geometry,
          .paper = "ours; after Laine et al. 2005 and Bergeron 1986",
          .output = visibility::Output::mask,
          .exact_for = "every pair of view sample and light sample, for any triangle soup",
          .lights = visibility::kEveryLight,
          .bytes_per_triangle = 400,
          .options = {engines::kEngine.description(), kExactRows.description()},
          .exact_area = visibility::ExactArea{visibility::kEveryLight, {{"rows", "exact"}}},
          .span = visibility::kFloatSpan,
          .verdict_on = verdict_on,
          .repairs = visibility::exact_pair_repairs};
}

}  // namespace

visibility::MethodDescription edge_scatter_description(const visibility::MethodOptions& given) {
  visibility::MethodDescription description = describe();
  const visibility::ParsedOptions options = visibility::parse_options(description, given);
  const bool on_device = options[engines::kEngine] == engines::Engine::vulkan;
  if (on_device && options[kExactRows])
    throw UsageError("edge-scatter: rows=exact runs only on the processor: omit engine=vulkan");
  if (on_device) description.lights = description.lights & visibility::kPlanarLights;
  if (!options[kExactRows]) return description;
  description.output = visibility::Output::radiance;
  description.exact_for =
      "the visible share of any light, textured or not, to float32 precision, for any triangle soup; the beauty image "
      "for constant radiance, pictures of domes, and textures of up to 64 x 64 texels";
  return description;
}

std::unique_ptr<visibility::Method> make_edge_scatter(const render::Machine& machine,
                                                      const visibility::MethodOptions& given) {
  visibility::MethodDescription description = edge_scatter_description(given);
  const visibility::ParsedOptions options = visibility::parse_options(description, given);
  const bool exact = options[kExactRows];
  const engines::Engine engine = options[engines::kEngine];
  const auto on_vectors = [](visibility::MethodDescription of, bool of_rows) {
    return visibility::with_domes(make_edge_scatter_on_vectors(std::move(of), of_rows));
  };
  if (exact || engines::runs_on_vectors(machine, engine)) return on_vectors(std::move(description), exact);
  if (engine == engines::Engine::vulkan) return std::make_unique<EdgeScatter>(machine.device(), std::move(description));
  return engines::make_engine_by_light(
      {[machine, description] { return std::make_unique<EdgeScatter>(machine.device(), description); },
       [on_vectors, description] { return on_vectors(description, false); }, is_planar_light});
}

bool edge_scatter_on_vectors(const render::Machine& machine, const visibility::MethodOptions& given,
                             const visibility::Light& light) {
  const visibility::ParsedOptions options = visibility::parse_options(describe(), given);
  const engines::Engine engine = options[engines::kEngine];
  return options[kExactRows] || engines::runs_on_vectors(machine, engine) ||
         (engine == engines::Engine::automatic && !is_planar_light(light));
}

}  // namespace penumbra::volumes
