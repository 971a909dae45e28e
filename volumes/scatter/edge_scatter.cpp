// Depth complexity by silhouette edges (Laine et al. 2005), for any soup by signed multiplicities (Bergeron 1986), on a
// grid of light samples: docs/edge-scatter.md.

#include "volumes/scatter/edge_scatter.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "engines/engine_by_light.hpp"
#include "engines/engine_choice.hpp"
#include "render/compute_pass.hpp"
#include "visibility/lights/device_light.hpp"
#include "volumes/edges/edge_method.hpp"
#include "volumes/edges/edge_scatter.shared.h"
#include "volumes/scatter/scatter_edges.comp.spv.hpp"
#include "volumes/scatter/vectors/edge_scatter_vectors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

constexpr std::array kLights{visibility::LightKind::rectangle, visibility::LightKind::disk,
                             visibility::LightKind::ellipse,   visibility::LightKind::polygon,
                             visibility::LightKind::sphere,    visibility::LightKind::sun};
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

class EdgeScatter final : public EdgeMethod {
 public:
  EdgeScatter(const render::Device& device, visibility::MethodDescription given)
      : EdgeMethod(device, std::move(given), sizeof(gpu::RowQuestion)) {}

  void prepare_light(const visibility::Light& light) override {
    if (!visibility::has_rows(light)) {
      throw InputError(
          "light \"{}\": edge-scatter with engine=vulkan takes light samples in rows of a rectangle (--sample-pattern "
          "rows or grid); without engine=vulkan it takes every light and pattern",
          light.name);
    }
    EdgeMethod::prepare_light(light);
  }

 private:
  /// As many light rows at a time as the histograms of a subgroup leave room for.
  device::MaskLayout prepare_kernel() override {
    PENUMBRA_ASSERT(device_light().rows, "light {} has no rows that a step describes", light().name);
    const std::uint32_t lanes = device().limits().subgroup_size;
    const std::uint32_t room = device().limits().max_shared_memory / (4 * lanes * light().columns);
    if (room == 0) {
      throw InputError(
          "light \"{}\": edge-scatter handles rows of up to {} light samples on {}; this has {}; use view-sample",
          light().name, device().limits().max_shared_memory / (lanes * 4), device().info().name, light().columns);
    }
    band_words_ = std::min({room, kMostBandWords, row_words()});
    const std::uint32_t block_width = lanes >= 32 ? 8 : 4;
    const std::vector<std::uint32_t> constants{lanes,           lanes,       block_width,
                                               light().columns, band_words_, light().columns * band_words_};
    if (!scatter_ || constants != constants_) {
      scatter_.emplace(device(), render::ComputePassOptions{.name = "scatter edges",
                                                            .spirv = shaders::kScatterEdgesComp,
                                                            .push_bytes = sizeof(gpu::ScatterPush),
                                                            .constants = constants,
                                                            .full_subgroups = true});
      constants_ = constants;
    }
    return blocks_of_samples();
  }

  /// Words of 8 columns × 4 rows, those of a column of words one after the other.
  [[nodiscard]] device::MaskLayout blocks_of_samples() const {
    device::MaskLayout layout{.words = column_words() * row_words()};
    for (std::uint32_t bit = 0; bit < 32 * layout.words; ++bit) {
      const std::uint32_t word = bit / 32, row = word % row_words() * 4 + bit % 32 / 8,
                          column = word / row_words() * 8 + bit % 8;
      const bool is_sample = row < light().rows && column < light().columns;
      layout.light_sample.push_back(is_sample ? row * light().columns + column : device::MaskLayout::kNone);
    }
    return layout;
  }
  [[nodiscard]] std::uint32_t row_words() const { return (light().rows + 3) / 4; }
  [[nodiscard]] std::uint32_t column_words() const { return (light().columns + 7) / 8; }

  [[nodiscard]] gpu::ScatterPush make_push() const override {
    gpu::ScatterPush push{};
    push.rows = light().rows;
    push.columns = light().columns;
    push.shift_step = device_light().shift_step;
    return push;
  }

  void record(const gpu::ScatterPush& push, std::vector<render::BufferReference> inputs,
              const visibility::Tile& band) override {
    if (push.side > 0) {
      commands().fill(counts(), 0, std::uint64_t{4} * push.first_pixel, std::uint64_t{4} * band.row_count * push.width);
    }
    inputs.insert(inputs.end(), {masks(), counts(), questions().buffer()});
    const std::uint64_t blocks =
        std::uint64_t{(push.width + kBlock - 1) / kBlock} * ((band.row_count + kBlock - 1) / kBlock);
    const std::uint32_t lanes = device().limits().subgroup_size,
                        bands = (light().rows + 4 * band_words_ - 1) / (4 * band_words_);
    scatter_->record(commands(), std::as_bytes(std::span(&push, 1)), inputs,
                     blocks * (kBlock * kBlock / lanes) * bands);
  }

  std::vector<device::OpenBits> open_bits(std::uint32_t count) override {
    std::vector<gpu::RowQuestion> asked(count);
    questions().read(std::span(asked));
    open_pixels_ += count;
    std::vector<device::OpenBits> open;
    for (const gpu::RowQuestion& question : asked) add_open(question, open);
    return open;
  }

  void add_open(const gpu::RowQuestion& question, std::vector<device::OpenBits>& open) {
    const std::uint64_t rows = question.low | std::uint64_t{question.high} << 32U;
    open_rows_ += static_cast<std::uint64_t>(std::popcount(rows));
    for (std::uint32_t row = question.first_row; row < std::min(question.first_row + 64, light().rows); row += 4) {
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
      const std::uint32_t row = sample / light().columns, column = sample % light().columns;
      if ((rows >> (row - question.first_row) & 1U) != 0) continue;  // asked already
      open.push_back({question.pixel, column / 8 * row_words() + row / 4, 1U << (row % 4 * 8 + column % 8)});
    }
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    EdgeMethod::count(counters);
    if (open_pixels_ == 0) return;
    counters["openPixels"] += std::exchange(open_pixels_, 0);
    counters["openRows"] += std::exchange(open_rows_, 0);
  }

  std::optional<render::ComputePass> scatter_;
  std::vector<std::uint32_t> constants_;
  std::uint32_t band_words_ = 1;
  std::uint64_t open_pixels_ = 0, open_rows_ = 0;  // to be counted
};

visibility::MethodDescription describe() {
  return {.name = "edge-scatter",
          .family = visibility::Family::geometry,
          .paper = "ours; after Laine et al. 2005 and Bergeron 1986",
          .output = visibility::Output::mask,
          .exact_for = "every pair of view sample and light sample, for any triangle soup",
          .lights = {kLights.begin(), kLights.end()},
          .options = {engines::kEngine.description(), kExactRows.description()},
          .exact_area = visibility::ExactArea{{kLights.begin(), kLights.end()}, {{"rows", "exact"}}},
          .verdict_on = verdict_on};
}

}  // namespace

visibility::MethodDescription edge_scatter_description(const visibility::MethodOptions& given) {
  visibility::MethodDescription description = describe();
  const visibility::ParsedOptions options = visibility::parse_options(description, given);
  const bool on_device = options[engines::kEngine] == engines::Engine::vulkan;
  if (on_device && options[kExactRows])
    throw UsageError("edge-scatter: rows=exact runs on the processor: leave engine=vulkan out");
  // Other lights are refused by the engine itself, which knows what can do them.
  if (on_device) description.exact_for += " (rows of a rectangle light)";
  if (!options[kExactRows]) return description;
  description.output = visibility::Output::radiance;
  description.exact_for =
      "the visible share of any light, textured or not, to float32, for any triangle soup; the beauty under "
      "constant radiance and textures of up to 64 x 64 texels";
  return description;
}

std::unique_ptr<visibility::Method> make_edge_scatter(const render::Device& device,
                                                      const visibility::MethodOptions& given) {
  visibility::MethodDescription description = edge_scatter_description(given);
  const visibility::ParsedOptions options = visibility::parse_options(description, given);
  const bool exact = options[kExactRows];
  const engines::Engine engine = options[engines::kEngine];
  if (exact || engines::runs_on_vectors(device, engine))
    return make_edge_scatter_on_vectors(std::move(description), exact);
  if (engine == engines::Engine::vulkan) return std::make_unique<EdgeScatter>(device, std::move(description));
  return engines::make_engine_by_light(
      {[&device, description] { return std::make_unique<EdgeScatter>(device, description); },
       [description] { return make_edge_scatter_on_vectors(description, false); }, visibility::has_rows});
}

bool edge_scatter_on_vectors(const render::Device& device, const visibility::MethodOptions& given,
                             const visibility::Light& light) {
  const visibility::ParsedOptions options = visibility::parse_options(describe(), given);
  const engines::Engine engine = options[engines::kEngine];
  return options[kExactRows] || engines::runs_on_vectors(device, engine) ||
         (engine == engines::Engine::automatic && !visibility::has_rows(light));
}

}  // namespace penumbra::volumes
