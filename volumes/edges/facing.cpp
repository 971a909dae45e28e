#include "volumes/edges/facing.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "render/commands.hpp"
#include "render/compute_pass.hpp"
#include "volumes/edges/facing.comp.spv.hpp"
#include "volumes/edges/facing.shared.h"
#include "volumes/edges/facing_upload.hpp"
#include "volumes/edges/patch_facing.comp.spv.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <optional>

namespace penumbra::volumes {
namespace {

constexpr std::uint32_t kPointsPerGroup = gpu::kLanes * gpu::kPointsPerLane;
constexpr std::uint64_t kListHead = sizeof(std::uint32_t);  // the list's count

/// Some of the mesh's triangles, as many as one buffer takes.
struct Chunk {
  std::uint32_t first_word = 0, word_count = 0;
  render::Buffer triangles;
};

}  // namespace

struct FacingPass::State {
  State(const render::Device& on, const FacingOptions& asked)
      : device(&on),
        most_bytes(asked.most_bytes != 0 ? asked.most_bytes : on.limits().max_storage_buffer_range),
        capacity(std::max(asked.first_list, 1U)),
        facing(on, {.name = "facing", .spirv = shaders::kFacingComp, .push_bytes = sizeof(gpu::FacingPush)}),
        patch(on, {.name = "patch facing", .spirv = shaders::kPatchFacingComp, .push_bytes = sizeof(std::uint32_t)}),
        commands(on) {}

  void run_until_the_list_holds() {
    for (;;) {
      render::grow(*device, list, "undecided facings",
                   kListHead + std::uint64_t{capacity} * sizeof(gpu::UndecidedWord));
      commands.fill(*list, 0, 0, kListHead);
      for (const Chunk& chunk : chunks) {
        const gpu::FacingPush push{.point_count = bits.point_count,
                                   .point_groups = (bits.point_count + kPointsPerGroup - 1) / kPointsPerGroup,
                                   .first_word = chunk.first_word,
                                   .word_count = chunk.word_count,
                                   .capacity = capacity};
        facing.record(commands, push, {chunk.triangles, *points, *front, *back, *list},
                      std::uint64_t{push.point_groups} * push.word_count);
      }
      submit();
      list->read(std::span(&undecided_words, 1));
      if (undecided_words <= capacity) return;
      const std::uint64_t most = std::uint64_t{words} * bits.point_count;  // max_points() leaves room for all of them
      capacity = static_cast<std::uint32_t>(std::min(undecided_words + std::uint64_t{undecided_words} / 8, most));
      ++counts.list_retries;
    }
  }

  /// The exact predicate for the pairs whose bit is set in both planes.
  void settle(gpu::UndecidedWord& word, std::span<const glm::vec3> at) const {
    const glm::vec3& p = at[word.word % bits.point_count];
    const std::uint32_t first = word.word / bits.point_count * 32;
    for (std::uint32_t open = word.front & word.back; open != 0; open &= open - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(open));
      mesh::Side side = mesh::Side::on;
      if (first + bit < triangles.size()) {
        const auto [a, b, c] = triangles[first + bit];
        side = mesh::side_of_plane(positions[a], positions[b], positions[c], p);
      }
      if (side != mesh::Side::front) word.front &= ~(1U << bit);
      if (side != mesh::Side::back) word.back &= ~(1U << bit);
    }
  }

  void settle_all(std::span<const glm::vec3> at) {
    if (undecided_words == 0) return;
    std::vector<gpu::UndecidedWord> open(undecided_words);
    list->read(std::span(open), kListHead);
    const auto start = std::chrono::steady_clock::now();
    std::atomic<std::uint64_t> undecided = 0;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, open.size(), 64), [&](const auto& range) {
      std::uint64_t bits_set = 0;
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        bits_set += static_cast<std::uint64_t>(std::popcount(open[i].front & open[i].back));
        settle(open[i], at);
      }
      undecided += bits_set;
    });
    counts.undecided += undecided;
    counts.host_milliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    list->write(std::span<const gpu::UndecidedWord>(open), kListHead);
    patch.record(commands, undecided_words, {*front, *back, *list}, (std::uint64_t{undecided_words} + 63) / 64);
    submit();
  }

  void submit() {
    for (const visibility::PassTime& pass : commands.submit()) counts.device_milliseconds += pass.milliseconds;
  }

  const render::Device* device;
  std::uint64_t most_bytes;
  std::uint32_t capacity;  // of the list
  render::ComputePass facing, patch;
  render::Commands commands;

  std::span<const glm::vec3> positions;
  std::span<const mesh::Triangle> triangles;
  std::optional<FacingUpload> upload;
  std::vector<Chunk> chunks;
  std::uint32_t words = 0;  // of one point

  FacingBits bits;  // sizes only
  std::unique_ptr<render::Buffer> points, front, back, list;
  std::uint32_t undecided_words = 0;
  FacingCounts counts;
};

FacingPass::FacingPass(const render::Device& device, const FacingOptions& options)
    : state_(std::make_unique<State>(device, options)) {}
FacingPass::~FacingPass() = default;
FacingPass::FacingPass(FacingPass&&) noexcept = default;
FacingPass& FacingPass::operator=(FacingPass&&) noexcept = default;

void FacingPass::prepare_mesh(std::span<const glm::vec3> positions, std::span<const mesh::Triangle> triangles) {
  State& s = *state_;
  PENUMBRA_ASSERT(triangles.size() <= 0xffffffe0U, "{} triangles", triangles.size());
  s.positions = positions;
  s.triangles = triangles;
  s.upload.emplace(positions);
  s.words = static_cast<std::uint32_t>((triangles.size() + 31) / 32);
  s.bits = {};
  s.bits.triangle_count = static_cast<std::uint32_t>(triangles.size());
  s.counts = {};
  s.chunks.clear();
  const std::uint64_t most_words = s.most_bytes / (32 * sizeof(gpu::FacingTriangle));
  PENUMBRA_ASSERT(most_words > 0, "buffers of {} bytes", s.most_bytes);
  for (std::uint64_t word = 0; word < s.words; word += most_words) {
    const std::uint64_t count = std::min(most_words, s.words - word);
    const auto part = triangles.subspan(word * 32, std::min<std::uint64_t>(count * 32, triangles.size() - word * 32));
    s.chunks.push_back(
        {static_cast<std::uint32_t>(word), static_cast<std::uint32_t>(count),
         render::make_buffer<gpu::FacingTriangle>(*s.device, "facing triangles", s.upload->triangles(part))});
  }
}

std::uint32_t FacingPass::max_points() const {
  const State& s = *state_;
  // All of a tile's words may be undecided, and the list must hold them; a point is no larger.
  const std::uint64_t per_point =
      std::max<std::uint64_t>(s.words * sizeof(gpu::UndecidedWord), sizeof(gpu::FacingPoint));
  const std::uint64_t most = std::min<std::uint64_t>((s.most_bytes - kListHead) / per_point, 1U << 30);
  if (most == 0) {
    throw ResourceError("facings of {} triangles from one point are more than this device's storage buffers can hold",
                        s.triangles.size());
  }
  return static_cast<std::uint32_t>(most < kPointsPerGroup ? most : most / kPointsPerGroup * kPointsPerGroup);
}

void FacingPass::evaluate(std::span<const glm::vec3> points) {
  State& s = *state_;
  PENUMBRA_ASSERT(points.size() <= max_points(), "{} points, at most {}", points.size(), max_points());
  s.bits.point_count = static_cast<std::uint32_t>(points.size());
  const std::uint64_t bytes = std::uint64_t{s.words} * points.size() * sizeof(std::uint32_t);
  if (bytes == 0) return;
  const std::vector<gpu::FacingPoint> upload = s.upload->points(points);
  render::grow(*s.device, s.points, "facing points", std::span(upload).size_bytes());
  s.points->write(std::span<const gpu::FacingPoint>(upload));
  render::grow(*s.device, s.front, "front facings", bytes);
  render::grow(*s.device, s.back, "back facings", bytes);
  s.run_until_the_list_holds();
  s.settle_all(points);
  s.counts.pairs += std::uint64_t{s.triangles.size()} * points.size();
}

const render::Buffer& FacingPass::front() const {
  PENUMBRA_ASSERT(state_->front != nullptr, "evaluate() comes first");
  return *state_->front;
}

const render::Buffer& FacingPass::back() const {
  PENUMBRA_ASSERT(state_->back != nullptr, "evaluate() comes first");
  return *state_->back;
}

FacingBits FacingPass::read() const {
  const State& s = *state_;
  FacingBits bits = s.bits;
  const std::size_t size = std::size_t{s.words} * bits.point_count;
  bits.front.resize(size);
  bits.back.resize(size);
  if (size == 0) return bits;
  s.front->read(std::span(bits.front));
  s.back->read(std::span(bits.back));
  return bits;
}

FacingCounts FacingPass::counts() const {
  return state_->counts;
}

}  // namespace penumbra::volumes
