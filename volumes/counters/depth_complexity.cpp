// SPDX-License-Identifier: Apache-2.0
// S. Laine, T. Aila, U. Assarsson, J. Lehtinen, T. Akenine-Möller, Soft shadow volumes for ray tracing, 2005: counters
// of light samples that change at silhouette edges. Departures (docs/depth-complexity.md): candidates come from a
// hierarchy of edges instead of wedges in a hemicube, signed multiplicities make it correct for any soup, the constant
// is counted at a certified corner, and cases left open by rounding are decided exactly.

#include "volumes/counters/methods.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "engines/engine_by_light.hpp"
#include "engines/engine_choice.hpp"
#include "render/compute_pass.hpp"
#include "visibility/masks/dome_method.hpp"
#include "visibility/method_repairs.hpp"
#include "volumes/counters/count_edges.comp.spv.hpp"
#include "volumes/counters/depth_complexity.shared.h"
#include "volumes/counters/packed_counters.hpp"
#include "volumes/counters/vectors/depth_complexity_vectors.hpp"
#include "volumes/edges/device/edge_method.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

namespace penumbra::volumes {
namespace {

constexpr std::uint32_t kQueued = 64;         // edges in the queue, as in count_edges.comp
constexpr std::size_t kMostEdges = 1U << 29;  // |k_e| of a record is at most 2: no counter can overflow

enum class Variant { soup, laine, forest };

constexpr visibility::ChoiceOption kVariant{
    "variant",
    {{"soup", Variant::soup}, {"laine", Variant::laine}, {"forest", Variant::forest}},
    Variant::soup,
    "soup: signed multiplicities, any mesh; laine: silhouettes and one reference ray, closed meshes; forest: "
    "silhouettes of the light's centre and hard volumes, in a pass for each 32 light samples"};
constexpr visibility::ChoiceOption kSearch{
    "search",
    {{"hierarchy", Search::hierarchy}, {"kd-tree", Search::kd_tree}, {"hemicube", Search::hemicube}},
    Search::hierarchy,
    "soup, on the processor: structure by which edges are found. kd-tree: over receivers (Lehtinen); hemicube: a grid "
    "around the light (Laine); both only for planar lights. The masks do not depend on it"};
constexpr auto kCrop = visibility::flag_option(
    "crop", true,
    "soup, laine: omit edges that are not silhouettes as seen from a group of view samples; V is the same");
constexpr visibility::ChoiceOption kCounterBits{
    "counter-bits",
    {{"6", 6U}, {"8", 8U}, {"16", 16U}},
    16U,
    "forest: bits of a packed counter; pairs whose counter overflows are decided exactly"};
constexpr visibility::ChoiceOption kAs{"as",
                                       {{"repaired", false}, {"published", true}},
                                       false,
                                       "forest: repaired: decides pairs exactly if counters overflow or signs are in "
                                       "doubt; published: uses the counters as they are"};

visibility::MeshVerdict depth_complexity_verdict(const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::exact,
      visibility::reason_with(
          "signed multiplicities hold for any soup, and every pair is decided exactly (variant=forest: only where no "
          "triangle's plane passes through the light)",
          mesh,
          {{mesh.boundary_loops, "open boundaries, where variant=laine is only approximate"},
           {mesh.non_manifold_edges.count, "non-manifold edges, where variant=laine is only approximate"},
           {mesh.zero_area_triangles.count,
            "triangles without area, which cast no shadow, and where variant=laine is only approximate"}})};
}

/// Returns whether vector units support the options: variant=soup, which skips edges that are not silhouettes.
bool can_be_native(const visibility::ParsedOptions& options) {
  return options[kVariant] == Variant::soup && options[kCrop];
}

/// Throws UsageError if the chosen variant does not have a given option.
visibility::ParsedOptions parse(const visibility::MethodDescription& description,
                                const visibility::MethodOptions& given) {
  visibility::ParsedOptions options = visibility::parse_options(description, given);
  const bool forest = options[kVariant] == Variant::forest;
  if (options[engines::kEngine] == engines::Engine::vectors && !can_be_native(options)) {
    throw UsageError("depth-complexity: variant={} and crop=off run only on the Vulkan device: omit engine=native",
                     options[kVariant] == Variant::soup ? "laine, forest" : kVariant.name_of(options[kVariant]));
  }
  if (options[kSearch] != Search::hierarchy &&
      (!can_be_native(options) || options[engines::kEngine] == engines::Engine::vulkan)) {
    throw UsageError(
        "depth-complexity: search={} runs only on the processor, with variant=soup and crop=on: omit engine=vulkan, "
        "variant and crop",
        kSearch.name_of(options[kSearch]));
  }
  if (forest ? options.given(kCrop) : options.given(kCounterBits) || options.given(kAs)) {
    throw UsageError("depth-complexity: variant={} has no option {}", kVariant.name_of(options[kVariant]),
                     forest                        ? kCrop.name()
                     : options.given(kCounterBits) ? kCounterBits.name()
                                                   : kAs.name());
  }
  return options;
}

visibility::ErrorRepairs depth_complexity_repairs(const visibility::MethodDescription& method,
                                                  const visibility::MethodOptions& given) {
  using visibility::ErrorCause;
  using visibility::repair_of;
  visibility::ErrorRepairs repairs = visibility::exact_pair_repairs(method, given);
  const visibility::MethodOptions options = visibility::complete_options(method, given);
  const std::string& variant = options.at(kVariant.name());
  if (variant == "soup") return repairs;
  // Not the visible area, which would also repair laine's errors on meshes that are not closed.
  repair_of(repairs, ErrorCause::samples) = visibility::more_light_samples(method, given);
  if (variant == "laine") return repairs;
  if (options.at(kAs.name()) == "published") {
    const char* words = "only with as=repaired, since errors of overflowing counters do not have this cause";
    repair_of(repairs, ErrorCause::view) = visibility::inseparable(ErrorCause::view, words);
    repair_of(repairs, ErrorCause::samples) = visibility::inseparable(ErrorCause::samples, words);
    return repairs;
  }
  repair_of(repairs, ErrorCause::view) = {
      .cause = ErrorCause::view,
      .runs = {{method.name, {{kVariant.name(), "soup"}}}},
      .words =
          "the silhouettes that each view sample sees, not the light's centre, at the same light samples "
          "(variant=soup)"};
  const visibility::RepairRun joined{"soft-irregular",
                                     {{"fusion", "union"}, {"silhouettes", "centre"}, {"umbra", "layers"}},
                                     1,
                                     visibility::kRepairSamples};
  repair_of(repairs, ErrorCause::samples) = {
      .cause = ErrorCause::samples,
      .runs = {joined},
      .words =
          fmt::format("the same layers at {} light samples (soft-irregular:fusion=union)", visibility::kRepairSamples)};
  repairs.one_view = {joined};
  return repairs;
}

bool is_planar_light(const visibility::Light& light) {
  return visibility::is_planar(light.kind);
}

class DepthComplexity final : public EdgeMethod, public DepthCounters {
 public:
  DepthComplexity(const render::Device& device, Variant variant, bool crops, bool keeps_depths)
      : EdgeMethod(device, depth_complexity_description(), sizeof(gpu::DepthQuestion), crops),
        variant_(variant),
        keeps_depths_(keeps_depths) {}

  void prepare_mesh(const visibility::SceneFloats& scene) override {
    EdgeMethod::prepare_mesh(scene);
    if (edges().edge_count() <= kMostEdges) return;
    throw ResourceError("depth-complexity counts up to {} edges without overflow; this scene has {}", kMostEdges,
                        edges().edge_count());
  }

  void prepare_light(const visibility::Light& light) override {
    visibility::require_kind(light, visibility::kPlanarLights,
                             ": depth-complexity on the Vulkan device (engine=vulkan, variant=laine, crop=off) "
                             "supports only planar lights ({}); without these options it supports every light",
                             visibility::kPlanarLights.words());
    EdgeMethod::prepare_light(light);
  }

  void evaluate(const visibility::Tile& tile) override {
    asked_.clear();
    const std::uint32_t pixels = tile.row_count * samples().width;
    // every view sample has one question: its reference ray
    if (variant_ == Variant::laine) questions().want(pixels + pixels / 8);
    EdgeMethod::evaluate(tile);
  }

  void read_counters(std::span<std::int32_t> counters) override {
    PENUMBRA_ASSERT(keeps_depths_ && counters.size() == tile_pixels() * light().sample_count(), "{}", counters.size());
    depths_->read(counters);
    for (const gpu::DepthQuestion& question : asked_) {
      if (question.word == gpu::kAllWords) {
        const std::size_t count = light().sample_count();
        std::ranges::fill(counters.subspan(question.pixel * count, count), DepthCounters::kNoCounter);
        continue;
      }
      for (std::uint32_t i = 0; i < 32; ++i) {
        if ((question.bits >> i & 1U) == 0) continue;
        counters[std::size_t{question.pixel} * light().sample_count() + std::size_t{question.word} * 32 + i] =
            DepthCounters::kNoCounter;
      }
    }
  }

 private:
  device::MaskLayout prepare_kernel() override {
    check_shared_memory();
    std::vector<glm::vec2> places;
    for (const glm::vec2& at : device_light().coordinates) places.push_back(at + 1.0F);
    places_.emplace(render::make_buffer<glm::vec2>(device(), "places of light samples", places));
    std::vector<std::uint32_t> touched(light().words_per_mask());
    for (const std::uint32_t sample : edges().touch().samples) touched[sample / 32] |= 1U << (sample % 32);
    touched_.emplace(render::make_buffer<std::uint32_t>(device(), "touched light samples", touched));
    build_pass();
    return {.words = light().words_per_mask()};
  }

  /// Shared memory: a counter for each light sample, two bits of masks, and the queue of edges.
  void check_shared_memory() const {
    const std::uint64_t needed = 4ULL * light().sample_count() + 8ULL * light().words_per_mask() + 24ULL * kQueued;
    if (needed <= device().limits().max_shared_memory) return;
    throw InputError(
        "light \"{}\": {} light samples need {} bytes of shared memory, but {} has {}; use fewer light samples, or the "
        "method view-sample",
        light().name, light().sample_count(), needed, device().info().name, device().limits().max_shared_memory);
  }

  void build_pass() {
    const std::uint32_t lanes = device().limits().subgroup_size;
    const std::vector<std::uint32_t> constants{lanes,
                                               lanes,
                                               light().sample_count(),
                                               light().words_per_mask(),
                                               variant_ == Variant::laine ? 1U : 0U,
                                               keeps_depths_ ? 1U : 0U};
    if (count_ && constants == constants_) return;
    count_.emplace(device(), render::ComputePassOptions{.name = "count edges",
                                                        .spirv = shaders::kCountEdgesComp,
                                                        .push_bytes = sizeof(gpu::ScatterPush),
                                                        .constants = constants,
                                                        .full_subgroups = true});
    constants_ = constants;
  }

  [[nodiscard]] std::uint64_t bytes_per_pixel() const override {
    return keeps_depths_ ? 4ULL * light().sample_count() : 0;
  }

  [[nodiscard]] gpu::ScatterPush make_push() const override {
    gpu::ScatterPush push{};
    push.rows = push.columns = 2;  // cells have the size of the frame's half-sizes
    return push;
  }

  device::Attempt run(const visibility::Tile& band) override {
    render::grow(device(), depths_, "counters", keeps_depths_ ? tile_pixels() * light().sample_count() * 4 : 4);
    if (keeps_depths_) {
      const std::uint64_t row_bytes = std::uint64_t{4} * samples().width * light().sample_count();
      commands().fill(*depths_, static_cast<std::uint32_t>(DepthCounters::kNoCounter), band.first_row * row_bytes,
                      band.row_count * row_bytes);
    }
    return EdgeMethod::run(band);
  }

  void record(const gpu::ScatterPush& push, std::vector<render::BufferReference> inputs,
              const visibility::Tile& band) override {
    inputs.insert(inputs.end(), {*places_, masks(), counts(), questions().buffer(), *depths_, *touched_});
    count_->record(commands(), std::as_bytes(std::span(&push, 1)), inputs, std::uint64_t{band.row_count} * push.width);
  }

  std::vector<device::OpenBits> open_bits(std::uint32_t count) override {
    std::vector<gpu::DepthQuestion> asked(count);
    questions().read(std::span(asked));
    asked_.insert(asked_.end(), asked.begin(), asked.end());
    std::vector<std::uint32_t> whole;
    for (const gpu::DepthQuestion& question : asked) {
      if (question.word == gpu::kAllWords) whole.push_back(question.pixel);
    }
    std::ranges::sort(whole);
    reference_rays_.clear();
    std::vector<device::OpenBits> open;
    for (const gpu::DepthQuestion& question : asked) {
      const std::uint32_t sample = question.word & ~gpu::kReference;
      if (question.word == gpu::kAllWords) {
        for (std::uint32_t word = 0; word < light().words_per_mask(); ++word) {
          const std::uint32_t left = light().sample_count() - 32 * word;
          open.push_back({question.pixel | device::gpu::kWholePixel, word, left >= 32 ? ~0U : (1U << left) - 1});
        }
        open_pairs_ += light().sample_count();
      } else if (std::ranges::binary_search(whole, question.pixel)) {
        continue;
      } else if ((question.word & gpu::kReference) != 0) {
        reference_rays_.push_back({question.pixel, sample / 32, 1U << (sample % 32)});
      } else {
        open.push_back({question.pixel, question.word, question.bits});
        open_pairs_ += static_cast<std::uint64_t>(std::popcount(question.bits));
      }
    }
    references_ += reference_rays_.size();
    open_words_ += open.size();
    return open;
  }

  /// If a reference ray is blocked (variant=laine), all light samples that are not separate questions are dark.
  void answer(std::span<const device::OpenBits> questions) override {
    std::vector<device::gpu::MaskWord> dark;
    const std::uint32_t words = light().words_per_mask();
    for (const device::gpu::MaskWord& ray : decide(reference_rays_)) {
      for (std::uint32_t i = 0; i < words && ray.bits == 0; ++i) {
        dark.push_back({ray.pixel, ray.pixel * words + i, ~0U, 0});
      }
    }
    settle(dark);
    settle(decide(questions));
  }

  void count(std::map<std::string, std::uint64_t>& counters) override {
    EdgeMethod::count(counters);
    if (references_ > 0) counters["referenceRays"] += references_;
    if (open_words_ > 0) counters["openWords"] += open_words_;
    if (open_words_ > 0) counters["openPairs"] += open_pairs_;
    references_ = open_words_ = open_pairs_ = 0;
  }

  Variant variant_;
  bool keeps_depths_;
  std::optional<render::ComputePass> count_;
  std::vector<std::uint32_t> constants_;
  std::optional<render::Buffer> places_, touched_;
  std::unique_ptr<render::Buffer> depths_;
  std::vector<gpu::DepthQuestion> asked_;                           // questions of the tile
  std::vector<device::OpenBits> reference_rays_;                    // reference rays of the band, for variant=laine
  std::uint64_t references_ = 0, open_words_ = 0, open_pairs_ = 0;  // counters
};

}  // namespace

visibility::MethodDescription depth_complexity_description(const visibility::MethodOptions& options) {
  visibility::MethodDescription description{
      .name = "depth-complexity",
      .family = visibility::Family::geometry,
      .paper = "Laine et al. 2005; Lehtinen et al. 2006; Forest et al. 2008; any soup: ours, after Bergeron 1986",
      .output = visibility::Output::mask,
      .exact_for =
          "variant=soup: every pair of view sample and light sample, for any triangle soup; variant=laine: "
          "the same for closed meshes whose triangles all have an area, approximate for others; variant=forest: the "
          "same where no occluding triangle's "
          "plane passes through the light, too bright elsewhere",
      .lights = visibility::kEveryLight,
      .bytes_per_triangle = 400,
      .options = {engines::kEngine.description(), kVariant.description(), kSearch.description(), kCrop.description(),
                  kCounterBits.description(), kAs.description()},
      .span = visibility::kFloatSpan,
      .verdict_on = depth_complexity_verdict,
      .repairs = depth_complexity_repairs};
  const visibility::ParsedOptions parsed = parse(description, options);
  if (parsed[engines::kEngine] == engines::Engine::vulkan || !can_be_native(parsed) ||
      parsed[kSearch] != Search::hierarchy)
    description.lights = description.lights & visibility::kPlanarLights;
  return description;
}

std::unique_ptr<visibility::Method> make_depth_complexity(const render::Machine& machine,
                                                          const visibility::MethodOptions& given) {
  const visibility::ParsedOptions options = parse(depth_complexity_description(), given);
  if (options[kVariant] == Variant::forest) {
    return make_packed_counters(machine.device(), {options[kCounterBits], options[kAs]});
  }
  const auto on_device = [machine, variant = options[kVariant], crops = options[kCrop]] {
    return std::make_unique<DepthComplexity>(machine.device(), variant, crops, false);
  };
  const auto native = [search = options[kSearch]] {
    return visibility::with_domes(make_depth_complexity_on_vectors(depth_complexity_description(), search));
  };
  const engines::Engine engine = options[engines::kEngine];
  if (!can_be_native(options) || engine == engines::Engine::vulkan) return on_device();
  if (options[kSearch] != Search::hierarchy || engines::runs_on_vectors(machine, engine)) return native();
  return engines::make_engine_by_light({on_device, native, is_planar_light});
}

bool depth_complexity_on_vectors(const render::Machine& machine, const visibility::MethodOptions& given,
                                 const visibility::Light& light) {
  const visibility::ParsedOptions options = parse(depth_complexity_description(), given);
  const engines::Engine engine = options[engines::kEngine];
  return can_be_native(options) &&
         (options[kSearch] != Search::hierarchy || engines::runs_on_vectors(machine, engine) ||
          (engine == engines::Engine::automatic && !is_planar_light(light)));
}

std::unique_ptr<DepthCounters> make_depth_counters(const render::Device& device) {
  return std::make_unique<DepthComplexity>(device, Variant::soup, true, true);
}

}  // namespace penumbra::volumes
