// SPDX-License-Identifier: Apache-2.0
// Host of silhouette_*.comp: computes facings by floats with a bound, and the rest by the exact predicate; then k_e and
// the list of silhouettes.

#include "volumes/edges/device/silhouette_pass.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "render/commands.hpp"
#include "render/compute_pass.hpp"
#include "volumes/edges/device/facing_upload.hpp"
#include "volumes/edges/device/silhouette_count.comp.spv.hpp"
#include "volumes/edges/device/silhouette_facing.comp.spv.hpp"
#include "volumes/edges/device/silhouette_fill.comp.spv.hpp"
#include "volumes/edges/device/silhouette_patch.comp.spv.hpp"
#include "volumes/edges/device/silhouette_scan.comp.spv.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace penumbra::volumes {
namespace {

constexpr std::uint64_t kListHead = sizeof(std::uint32_t);  // the list's count

std::uint64_t groups_of(std::uint64_t lanes) {
  return (lanes + 63) / 64;
}

/// The triangles at edges (silhouette.shared.h).
struct Incidences {
  std::vector<std::array<std::uint32_t, 2>> pairs;  // for every edge
  std::vector<std::uint32_t> first{0}, more;        // edges with more than two triangles, in CSR format
};

/// `nothing`: index of the triangle that never counts.
Incidences incidences_of(const mesh::EdgeGraph& graph, std::uint32_t nothing) {
  Incidences result;
  result.pairs.resize(graph.edges.size(), {2 * nothing, 2 * nothing});
  for (std::uint32_t edge = 0; edge < graph.edges.size(); ++edge) {
    const std::span<const mesh::Incidence> around = graph.around(edge);
    const auto word = [&](std::size_t i) { return around[i].triangle * 2 + (around[i].reversed ? 1 : 0); };
    if (around.size() <= 2) {
      for (std::size_t i = 0; i < around.size(); ++i) result.pairs[edge][i] = word(i);
      continue;
    }
    result.pairs[edge][0] = gpu::kManyIncidences | static_cast<std::uint32_t>(result.first.size() - 1);
    for (std::size_t i = 0; i < around.size(); ++i) result.more.push_back(word(i));
    result.first.push_back(static_cast<std::uint32_t>(result.more.size()));
  }
  return result;
}

}  // namespace

struct SilhouettePass::State {
  State(const render::Device& on, std::uint64_t most)
      : device(&on),
        most_bytes(most != 0 ? most : on.limits().max_storage_buffer_range),
        facing(on, {.name = "silhouette facings",
                    .spirv = shaders::kSilhouetteFacingComp,
                    .push_bytes = sizeof(gpu::SilhouetteFacingPush)}),
        patch(on, pass("silhouette patch", shaders::kSilhouettePatchComp)),
        count_edges(on, pass("silhouette count", shaders::kSilhouetteCountComp)),
        scan(on, pass("silhouette scan", shaders::kSilhouetteScanComp)),
        fill(on, pass("silhouette fill", shaders::kSilhouetteFillComp)),
        commands(on) {}

  static render::ComputePassOptions pass(const char* name, std::span<const std::uint32_t> spirv) {
    return {.name = name, .spirv = spirv, .push_bytes = sizeof(std::uint32_t)};
  }

  void make_buffers();
  void find_facings(const glm::vec3& l);
  void settle(const glm::vec3& l);
  void count_blocks();
  void submit() { times.add(commands.submit()); }
  [[nodiscard]] std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(mesh.triangles.size()); }
  [[nodiscard]] std::uint32_t edge_count() const { return static_cast<std::uint32_t>(mesh.graph->edges.size()); }
  [[nodiscard]] std::uint32_t block_count() const {
    return static_cast<std::uint32_t>((std::uint64_t{edge_count()} + gpu::kEdgesPerBlock - 1) / gpu::kEdgesPerBlock);
  }

  const render::Device* device;
  std::uint64_t most_bytes;
  render::ComputePass facing, patch, count_edges, scan, fill;
  render::Commands commands;

  SilhouetteMesh mesh;
  std::optional<FacingUpload> upload;
  using BufferPointer = std::unique_ptr<render::Buffer>;
  BufferPointer triangles, positions, pairs, first, more, ends;                    // made for each mesh
  BufferPointer counted_buffer, sides, open, multiplicities, blocks, silhouettes;  // made for each point
  std::vector<std::uint32_t> counted;                                              // content of counted_buffer
  std::uint32_t found = 0;
  std::uint32_t open_facings = 0;
  visibility::PassTimes times;
};

SilhouettePass::SilhouettePass(const render::Device& device, std::uint64_t most_bytes)
    : state_(std::make_unique<State>(device, most_bytes)) {}
SilhouettePass::~SilhouettePass() = default;
SilhouettePass::SilhouettePass(SilhouettePass&&) noexcept = default;
SilhouettePass& SilhouettePass::operator=(SilhouettePass&&) noexcept = default;

std::uint32_t SilhouettePass::most_triangles() const {
  // The buffer of triangles is the largest: an edge takes at most 8 bytes in any buffer, and there are at most three
  // edges for each triangle.
  static_assert(sizeof(gpu::FacingTriangle) >= 3 * sizeof(gpu::Silhouette) + sizeof(std::uint32_t));
  const std::uint64_t most = state_->most_bytes / sizeof(gpu::FacingTriangle);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(most / 32 * 32, 1U << 28));
}

bool SilhouettePass::prepare_mesh(const SilhouetteMesh& mesh) {
  State& s = *state_;
  s.mesh = mesh;
  s.found = 0;
  s.open_facings = 0;
  s.counted.clear();
  const std::uint64_t most_positions = s.most_bytes / sizeof(glm::vec3);
  if (mesh.triangles.size() > most_triangles() || mesh.positions.size() > most_positions) return false;
  s.upload.emplace(mesh.positions);
  if (!mesh.triangles.empty()) s.make_buffers();
  return true;
}

void SilhouettePass::State::make_buffers() {
  const auto make = [&]<typename T>(const char* name, std::span<const T> values) {
    return std::make_unique<render::Buffer>(render::make_buffer<T>(*device, name, values));
  };
  static_assert(sizeof(mesh::Edge) == 2 * sizeof(std::uint32_t));
  triangles = make("silhouette triangles", std::span<const gpu::FacingTriangle>(upload->triangles(mesh.triangles)));
  positions = make("silhouette positions", mesh.positions);
  const Incidences incidences = incidences_of(*mesh.graph, triangle_count());
  pairs = make("silhouette edges", std::span<const std::array<std::uint32_t, 2>>(incidences.pairs));
  first = make("silhouette edges of many", std::span<const std::uint32_t>(incidences.first));
  more = make("silhouette incidences", std::span<const std::uint32_t>(incidences.more));
  ends = make("silhouette ends", std::span<const mesh::Edge>(mesh.graph->edges));
  const std::uint64_t n = triangle_count(), edges = std::max(edge_count(), 1U);
  counted_buffer = std::make_unique<render::Buffer>(*device, "silhouette sides that count", n * sizeof(std::uint32_t));
  sides = std::make_unique<render::Buffer>(*device, "silhouette sides", (n + 1) * sizeof(std::uint32_t));
  commands.fill(*sides, 0);  // the sides of the padding stay 0
  commands.submit();
  open = std::make_unique<render::Buffer>(*device, "silhouette open facings", kListHead + n * sizeof(gpu::OpenFacing));
  multiplicities = std::make_unique<render::Buffer>(*device, "silhouette multiplicities", edges * sizeof(std::int32_t));
  blocks = std::make_unique<render::Buffer>(*device, "silhouette blocks",
                                            (std::uint64_t{block_count()} + 1) * sizeof(std::uint32_t));
}

void SilhouettePass::evaluate(const glm::vec3& l, std::span<const std::uint32_t> counted) {
  State& s = *state_;
  PENUMBRA_ASSERT(counted.size() == s.mesh.triangles.size(), "{} sides of {} triangles", counted.size(),
                  s.mesh.triangles.size());
  s.found = 0;
  s.open_facings = 0;
  if (counted.empty() || s.edge_count() == 0) return;
  if (!std::ranges::equal(s.counted, counted)) {
    s.counted.assign(counted.begin(), counted.end());
    s.counted_buffer->write(counted);
  }
  s.find_facings(l);
  s.count_blocks();
  s.submit();
  s.open->read(std::span(&s.open_facings, 1));
  if (s.open_facings != 0) s.settle(l);
  s.blocks->read(std::span(&s.found, 1), std::uint64_t{s.block_count()} * sizeof(std::uint32_t));
  if (s.found == 0) return;
  render::grow(*s.device, s.silhouettes, "silhouettes", std::uint64_t{s.found} * sizeof(gpu::Silhouette));
  s.fill.record(s.commands, s.edge_count(), {*s.multiplicities, *s.blocks, *s.silhouettes}, groups_of(s.block_count()));
  s.submit();
}

void SilhouettePass::State::find_facings(const glm::vec3& l) {
  const gpu::SilhouetteFacingPush push{upload->points(std::span(&l, 1)).front(), triangle_count()};
  commands.fill(*open, 0, 0, kListHead);
  facing.record(commands, push, {*triangles, *counted_buffer, *sides, *open}, groups_of(triangle_count()));
}

/// Applies the exact predicate to open facings, and repeats the steps that depend on facings.
void SilhouettePass::State::settle(const glm::vec3& l) {
  std::vector<gpu::OpenFacing> list(open_facings);
  open->read(std::span(list), kListHead);
  for_each_index(list.size(), [&](std::size_t i) {
    const auto [a, b, c] = mesh.triangles[list[i].triangle];
    list[i].side = bits_of(mesh::side_of_plane(mesh.positions[a], mesh.positions[b], mesh.positions[c], l));
  });
  open->write(std::span<const gpu::OpenFacing>(list), kListHead);
  patch.record(commands, open_facings, {*counted_buffer, *sides, *open}, groups_of(open_facings));
  count_blocks();
  submit();
}

void SilhouettePass::State::count_blocks() {
  commands.fill(*blocks, 0);
  count_edges.record(commands, edge_count(), {*pairs, *first, *more, *sides, *multiplicities, *blocks},
                     groups_of(edge_count()));
  scan.record(commands, block_count(), {*blocks}, 1);
}

std::vector<std::uint32_t> SilhouettePass::read_sides() const {
  std::vector<std::uint32_t> sides(state_->mesh.triangles.size());
  if (!sides.empty() && state_->edge_count() != 0) state_->sides->read(std::span(sides));
  return sides;
}

std::vector<mesh::SilhouetteEdge> SilhouettePass::read_edges() const {
  static_assert(sizeof(mesh::SilhouetteEdge) == sizeof(gpu::Silhouette));
  std::vector<mesh::SilhouetteEdge> edges(state_->found);
  if (!edges.empty()) state_->silhouettes->read(std::span(edges));
  return edges;
}

std::uint32_t SilhouettePass::count() const {
  return state_->found;
}
const render::Buffer& SilhouettePass::silhouettes() const {
  PENUMBRA_ASSERT(state_->silhouettes != nullptr, "no silhouettes");
  return *state_->silhouettes;
}
const render::Buffer& SilhouettePass::ends() const {
  return *state_->ends;
}
const render::Buffer& SilhouettePass::positions() const {
  return *state_->positions;
}
std::uint64_t SilhouettePass::open_facings() const {
  return state_->open_facings;
}

std::vector<visibility::PassTime> SilhouettePass::take_pass_times() {
  return state_->times.take();
}

std::uint64_t SilhouettePass::memory_bytes() const {
  const State& s = *state_;
  std::uint64_t bytes = 0;
  for (const auto* buffer : {&s.triangles, &s.positions, &s.pairs, &s.first, &s.more, &s.ends, &s.counted_buffer,
                             &s.sides, &s.open, &s.multiplicities, &s.blocks, &s.silhouettes}) {
    if (*buffer) bytes += (*buffer)->bytes();
  }
  return bytes;
}

}  // namespace penumbra::volumes
