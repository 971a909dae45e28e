// SPDX-License-Identifier: Apache-2.0
// Host of the passes that rasterise penumbra wedges and add up a fragment shader's integers at each receiver.

#include "volumes/raster/wedge_raster.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/raster_pass.hpp"
#include "volumes/wedges/light_hull.hpp"
#include "volumes/raster/screen_box.hpp"
#include "volumes/raster/small_vectors.hpp"
#include "volumes/raster/wedge_footprint.vert.spv.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace penumbra::volumes {
namespace {

using visibility::Tile;
using visibility::ViewSamples;

constexpr std::uint32_t kFanVertices = 3 * (Footprint::kMost - 2);

}  // namespace

LightWedges wedges_of(const LightVolumes& volumes, const visibility::Light& light, Construction construction) {
  std::vector<WedgeEdge> edges(volumes.edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    edges[i].a = volumes.edges[i].a;
    edges[i].b = volumes.edges[i].b;
  }
  return {volumes.edges, build_wedges(edges, light_hull(light), construction)};
}

std::vector<gpu::WedgeFace> faces_of(const LightWedges& wedges, const ViewSamples& samples, WedgeTests tests,
                                     const glm::dvec3& center) {
  static_assert(std::size(gpu::WedgeFace{}.corners) == Footprint::kMost);
  const Receivers receivers(samples, tests == WedgeTests::both ? std::optional(center) : std::nullopt);
  if (receivers.empty()) return {};
  require_perspective(samples.camera);
  const FootprintFinder finder(samples.camera, receivers, tests);
  std::vector<std::size_t> first(wedges.edges.size() + 1, wedges.wedges.size());
  for (std::size_t i = wedges.wedges.size(); i-- > 0;) first[wedges.wedges[i].source] = i;
  std::vector<gpu::WedgeFace> faces(wedges.edges.size());
  for_each_index(faces.size(), [&](std::size_t i) {
    const std::span<const Wedge> pieces = std::span(wedges.wedges).subspan(first[i], first[i + 1] - first[i]);
    const std::optional<Footprint> footprint = finder.around(pieces);
    if (!footprint) return;
    const VolumeEdge& edge = wedges.edges[i];
    faces[i] = {
        edge.a, edge.b, edge.multiplicity, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(footprint->size),
        {}};
    std::ranges::copy(footprint->corners, std::begin(faces[i].corners));
  });
  std::erase_if(faces, [](const gpu::WedgeFace& face) { return face.corner_count == 0; });
  return faces;
}

std::uint64_t fragments_of(std::span<const gpu::WedgeFace> faces) {
  double sum = 0;
  for (const gpu::WedgeFace& face : faces) {
    double twice = 0;
    for (std::uint32_t i = 0; i < face.corner_count; ++i) {
      const glm::dvec2 p(face.corners[i]), q(face.corners[(i + 1) % face.corner_count]);
      twice += p.x * q.y - p.y * q.x;
    }
    sum += std::abs(twice) / 2;
  }
  return static_cast<std::uint64_t>(sum);
}

gpu::WedgePush wedge_push(const visibility::Light& light) {
  const auto [center, u, v] = visibility::light_frame(light);
  const glm::dvec3 n = glm::cross(u, v);
  const glm::dvec3 across_v = glm::cross(v, n), across_u = glm::cross(n, u);
  gpu::WedgePush push{};
  store(push.c, glm::dvec3(center_of(light)));
  store(push.u_dual, across_v / glm::dot(u, across_v));
  store(push.v_dual, across_u / glm::dot(v, across_u));
  store(push.n, n);
  return push;
}

bool appears_in_place(const visibility::PinholeCamera& camera, const glm::vec3& p, std::size_t pixel) {
  const std::size_t column = pixel % camera.width, row = pixel / camera.width;
  const glm::dvec2 center(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  return BoxFinder(camera).appears_at(p, center);
}

struct WedgeRaster::State {
  State(const render::Device& on, const WedgeShader& shader)
      : device(&on),
        pass(on, {.name = shader.name,
                  .vertex = shaders::kWedgeFootprintVert,
                  .fragment = shader.fragment,
                  .push_bytes = sizeof(gpu::WedgePush),
                  .constants = shader.constants}),
        words(shader.words),
        table(shader.table),
        table_buffer(render::make_buffer<double>(on, "wedge table", {})) {
    table_buffer.write<double>(std::array{0.0});
  }

  const render::Device* device;
  render::RasterPass pass;
  std::uint32_t words;
  bool table;
  render::Buffer table_buffer;
  std::unique_ptr<render::Buffer> face_buffer, receiver_buffer, sum_buffer, doubt_buffer;
  std::vector<std::int64_t> sums;
  std::vector<std::uint32_t> doubts;
  visibility::PassTimes times;
};

WedgeRaster::WedgeRaster(const render::Device& device, const WedgeShader& shader)
    : state_(std::make_unique<State>(device, shader)) {}
WedgeRaster::~WedgeRaster() = default;
WedgeRaster::WedgeRaster(WedgeRaster&&) noexcept = default;
WedgeRaster& WedgeRaster::operator=(WedgeRaster&&) noexcept = default;

void WedgeRaster::set_table(std::span<const double> table) {
  state_->table_buffer = render::make_buffer(*state_->device, "wedge table", table);
}

void WedgeRaster::add(std::span<const gpu::WedgeFace> faces, std::span<const gpu::WedgeReceiver> receivers,
                      gpu::WedgePush push, const Tile& tile, std::uint32_t width) {
  State& s = *state_;
  PENUMBRA_ASSERT(receivers.size() == std::size_t{tile.row_count} * width, "{} receivers for {} rows of {} pixels",
                  receivers.size(), tile.row_count, width);
  s.sums.resize(receivers.size() * s.words);
  s.doubts.resize(receivers.size());
  if (receivers.empty()) return;
  render::grow(*s.device, s.receiver_buffer, "wedge receivers", receivers.size_bytes());
  render::grow(*s.device, s.sum_buffer, "wedge sums", s.sums.size() * sizeof(std::int64_t));
  render::grow(*s.device, s.doubt_buffer, "wedge doubts", receivers.size() * sizeof(std::uint32_t));
  s.receiver_buffer->write(receivers);
  push.width = width;
  push.first_row = tile.first_row;
  push.row_count = tile.row_count;
  render::Commands commands(*s.device);
  commands.fill(*s.sum_buffer, 0);
  commands.fill(*s.doubt_buffer, 0);
  const std::size_t most = s.device->limits().max_storage_buffer_range / sizeof(gpu::WedgeFace);
  for (std::size_t first = 0; first < faces.size(); first += most) {
    const std::span<const gpu::WedgeFace> batch = faces.subspan(first, std::min(most, faces.size() - first));
    render::grow(*s.device, s.face_buffer, "wedge faces", batch.size_bytes());
    s.face_buffer->write(batch);
    const render::RasterPass::Draw draw{.width = width,
                                        .height = tile.row_count,
                                        .vertices = kFanVertices,
                                        .instances = static_cast<std::uint32_t>(batch.size())};
    std::vector<render::BufferReference> buffers{*s.face_buffer, *s.receiver_buffer, *s.sum_buffer, *s.doubt_buffer};
    if (s.table) buffers.emplace_back(s.table_buffer);
    s.pass.record(commands, std::as_bytes(std::span(&push, 1)), buffers, draw);
    s.times.add(commands.submit());
  }
  commands.submit();  // runs the fills if there was no face
  s.sum_buffer->read<std::int64_t>(s.sums);
  s.doubt_buffer->read<std::uint32_t>(s.doubts);
}

std::span<const std::int64_t> WedgeRaster::sums() const {
  return state_->sums;
}
std::span<const std::uint32_t> WedgeRaster::doubts() const {
  return state_->doubts;
}

std::uint32_t WedgeRaster::max_tile_rows(const ViewSamples& samples) const {
  const std::uint64_t row = std::max<std::uint64_t>(samples.width, 1) *
                            std::max(sizeof(gpu::WedgeReceiver), state_->words * sizeof(std::int64_t));
  const std::uint64_t rows = state_->device->limits().max_storage_buffer_range / row;
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(rows, 1, std::max(samples.height, 1u)));
}

std::vector<visibility::PassTime> WedgeRaster::take_pass_times() {
  return state_->times.take();
}

std::uint64_t WedgeRaster::memory_bytes() const {
  const State& s = *state_;
  std::uint64_t bytes = s.table_buffer.bytes();
  for (const auto* buffer : {&s.face_buffer, &s.receiver_buffer, &s.sum_buffer, &s.doubt_buffer}) {
    if (*buffer) bytes += (*buffer)->bytes();
  }
  return bytes;
}

}  // namespace penumbra::volumes
