// SPDX-License-Identifier: Apache-2.0
// Shadow volumes: F. Crow, Shadow algorithms for computer graphics, 1977; counted per pixel, T. Heidmann, Real shadows,
// real time, 1991; beyond the pixel's surface (B. Bilodeau, M. Songy 1999; J. Carmack 2000) and out to infinity (C.
// Everitt, M. Kilgard, Practical and robust stenciled shadow volumes, 2002). Departures: integers in a buffer instead
// of a stencil, which wraps; any soup, by signed multiplicity; the far end is a fan for each silhouette edge, not a cap
// for each triangle; the rasteriser proposes, and signs in double decide (volumes/README.md, Counting).

#include "volumes/raster/volume_count.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/raster_pass.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "volumes/raster/light_volumes.hpp"
#include "volumes/raster/screen_box.hpp"
#include "volumes/raster/shadow_tiles.hpp"
#include "volumes/raster/small_vectors.hpp"
#include "volumes/raster/volume_count.frag.spv.hpp"
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/volume_face.vert.spv.hpp"
#include "volumes/raster/volume_faces.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::SceneFloats;
using visibility::Tile;
using visibility::ViewSamples;

constexpr std::array kNames{"volume sides", "volume far ends", "volume caps", "volume lower ends", "volume upper ends"};

render::RasterPass make_pass(const render::Device& device, FaceKind kind, bool before, bool parts) {
  return render::RasterPass(device, {.name = kNames[kind],
                                     .vertex = shaders::kVolumeFaceVert,
                                     .fragment = shaders::kVolumeCountFrag,
                                     .push_bytes = sizeof(gpu::VolumePush),
                                     .constants = {kind, before ? 1u : 0u, parts ? 1u : 0u},
                                     .triangle_strip = true});
}

/// Returns whether p is projected into its pixel, and also the point where the line from p to l meets the carrier's
/// plane. Rounding moved p; next to the camera, or under grazing light, this can be several pixels.
bool appears_in_place(const BoxFinder& boxes, const std::array<glm::vec3, 3>& carrier, const glm::vec3& p,
                      const glm::vec3& l, const glm::dvec2& center) {
  const glm::dvec3 a = carrier[0], to_light = glm::dvec3(l) - glm::dvec3(p);
  const glm::dvec3 normal = glm::cross(glm::dvec3(carrier[1]) - a, glm::dvec3(carrier[2]) - a);
  const double s = glm::dot(normal, glm::dvec3(p) - a) / glm::dot(normal, to_light);
  return boxes.appears_at(p, center) && boxes.appears_at(glm::dvec3(p) - to_light * s, center);
}

}  // namespace

struct VolumeCount::State {
  State(const render::Device& on, CountVariant which, Layers of, bool in_parts)
      : device(&on), variant(which), layers(of) {
    std::vector<FaceKind> needed{kSideFaces, kFanFaces, kCapFaces};
    if (in_parts) needed.insert(needed.end(), {kLowerFanFaces, kUpperFanFaces});
    for (const FaceKind kind : needed) static_cast<void>(pass_of(kind, which != CountVariant::z_fail, in_parts));
  }

  const render::Device* device;
  CountVariant variant;
  Layers layers;
  bool whole_tiles = false;                                  // decide_whole_tiles
  std::array<std::optional<render::RasterPass>, 20> passes;  // made when first needed

  const SceneFloats* scene = nullptr;
  const visibility::Light* light = nullptr;
  const ViewSamples* samples = nullptr;
  std::optional<ShadowCasters> casters;
  std::optional<visibility::TriangleTree> tree;  // made for the first doubtful pixel
  LightVolumes volumes;

  std::optional<VolumeFaces> faces;  // for this light and view

  std::unique_ptr<render::Buffer> face_buffer, receiver_buffer, count_buffer, doubt_buffer, part_buffer;
  std::vector<gpu::VolumeReceiver> receivers;
  std::vector<std::uint32_t> doubts;
  std::vector<std::uint32_t> stand_ins;  // with whole_tiles: TilePlan::stand_ins
  std::vector<std::int32_t> counts;
  std::vector<Kind> kinds;
  Totals totals;
  visibility::PassTimes times;

  const render::RasterPass& pass_of(FaceKind kind, bool before, bool parts);
  void find_faces();
  void classify(const Tile& tile);
  void leave_out_whole_tiles();
  void copy_in_whole_tiles();
  void rasterise(const Tile& tile);
  void count_doubtful(const Tile& tile);
  [[nodiscard]] std::int32_t count_exactly(std::size_t pixel) const;
};

VolumeCount::VolumeCount(const render::Device& device, CountVariant variant, Layers layers, bool in_parts)
    : state_(std::make_unique<State>(device, variant, layers, in_parts)) {}
VolumeCount::~VolumeCount() = default;
VolumeCount::VolumeCount(VolumeCount&&) noexcept = default;
VolumeCount& VolumeCount::operator=(VolumeCount&&) noexcept = default;

void VolumeCount::prepare_mesh(const SceneFloats& scene) {
  prepare_scene(scene);
  state_->casters.emplace(scene, state_->layers);
}

void VolumeCount::decide_whole_tiles() {
  state_->whole_tiles = true;
}

void VolumeCount::prepare_scene(const SceneFloats& scene) {
  State& s = *state_;
  s.scene = &scene;
  s.light = nullptr;
  s.samples = nullptr;
  s.tree.reset();
  s.casters.reset();
}

void VolumeCount::prepare_light(const visibility::Light& light) {
  PENUMBRA_ASSERT(state_->casters.has_value(), "prepare_light before prepare_mesh");
  prepare_light(light, state_->casters->seen_from(center_of(light), light));
}

void VolumeCount::prepare_light(const visibility::Light& light, LightVolumes volumes) {
  State& s = *state_;
  // Counts are sums of at most three faces for each triangle and edge: far below the range of 32 bits.
  PENUMBRA_ASSERT(s.scene != nullptr && volumes.caps.size() < (1u << 28), "{} triangles", volumes.caps.size());
  s.light = &light;
  s.volumes = std::move(volumes);
  s.faces.reset();
  s.totals = {};
  s.totals.silhouette_edges = s.volumes.edges.size();
  s.totals.caps = s.volumes.caps.size();
}

void VolumeCount::prepare_view(const ViewSamples& samples) {
  State& s = *state_;
  PENUMBRA_ASSERT(samples.camera.width == samples.width && samples.camera.height == samples.height,
                  "view samples of {}×{} from a camera of {}×{}", samples.width, samples.height, samples.camera.width,
                  samples.camera.height);
  if (samples.width > s.device->limits().max_image_size) {
    throw ResourceError("--size {}x{}: this device draws at most {} pixels in a row", samples.width, samples.height,
                        s.device->limits().max_image_size);
  }
  s.samples = &samples;
  s.faces.reset();
}

std::uint32_t VolumeCount::max_tile_rows() const {
  const State& s = *state_;
  const std::uint64_t rows = s.device->limits().max_storage_buffer_range /
                             (std::max<std::uint64_t>(s.samples->width, 1) * sizeof(gpu::VolumeReceiver));
  const std::uint64_t most = std::min(std::max(s.samples->height, 1u), s.device->limits().max_image_size);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(rows, 1, most));
}

const render::RasterPass& VolumeCount::State::pass_of(FaceKind kind, bool before, bool parts) {
  std::optional<render::RasterPass>& pass = passes[4 * kind + (before ? 2U : 0U) + (parts ? 1U : 0U)];
  if (!pass) pass.emplace(make_pass(*device, kind, before, parts));
  return *pass;
}

void VolumeCount::State::find_faces() {
  if (faces) return;
  faces = faces_on_screen(volumes, samples->camera, variant);
  totals.faces_on_screen = faces->count(kSideFaces) + faces->count(kCapFaces) + faces->count(kFanFaces) +
                           faces->count(kLowerFanFaces) + faces->count(kUpperFanFaces);
  totals.far_ends_on_screen = faces->count(kFanFaces);
  totals.fragments = faces->fragments;
  totals.toggling_parts = static_cast<std::uint64_t>(std::ranges::count_if(
      faces->parts, [](const gpu::VolumePart& part) { return (part.bounds & gpu::kToggles) != 0; }));
  totals.from_eye = variant == CountVariant::z_pass_from_eye && faces->before;
}

void VolumeCount::State::classify(const Tile& tile) {
  const std::size_t first = std::size_t{tile.first_row} * samples->width;
  const std::size_t pixels = std::size_t{tile.row_count} * samples->width;
  receivers.assign(pixels, {glm::vec3(0), gpu::kNotCounted});
  kinds.assign(pixels, Kind::lit);
  doubts.assign(pixels, 0);
  const BoxFinder boxes(samples->camera);
  for_each_index(pixels, [&](std::size_t i) {
    const std::size_t pixel = first + i;
    if (!visibility::is_receiver(*scene, *light, *samples, pixel)) return;
    const auto carrier = static_cast<std::uint32_t>(samples->triangle[pixel]);
    const std::array<glm::vec3, 3> corners = scene->corners(carrier);
    const glm::vec3& p = samples->p[pixel];
    const bool faces_light = visibility::above_horizon(corners, samples->facing[pixel], volumes.l) &&
                             visibility::in_front_of_light(*light, p);
    kinds[i] = faces_light ? Kind::counted : Kind::dark;
    if (!faces_light) return;
    const std::size_t column = pixel % samples->width, row = pixel / samples->width;
    const glm::dvec2 center(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    receivers[i] = {p, scene->plane[carrier]};
    if (!appears_in_place(boxes, corners, p, volumes.l, center)) doubts[i] = gpu::kDoubtBit;
  });
  if (whole_tiles) leave_out_whole_tiles();
  for (std::size_t i = 0; i < pixels; ++i) {
    totals.counted_pixels += receivers[i].plane != gpu::kNotCounted ? 1 : 0;
    if (doubts[i] != 0) receivers[i].plane = gpu::kNotCounted;  // left to the host
  }
}

/// Leaves only one view sample of each whole tile to be counted.
void VolumeCount::State::leave_out_whole_tiles() {
  PENUMBRA_ASSERT(volumes.parts.empty(), "tiles of volumes in {} parts", volumes.parts.size());
  TilePlan plan = plan_tiles(volumes, receivers, samples->width);
  stand_ins = std::move(plan.stand_ins);
  totals.tiles += plan.tiles;
  totals.whole_tiles += plan.whole;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    if (stand_ins[i] == i) continue;
    receivers[i].plane = gpu::kNotCounted;
    doubts[i] = 0;
  }
}

void VolumeCount::State::copy_in_whole_tiles() {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (stand_ins[i] != kNoPixel) counts[i] = counts[stand_ins[i]];
  }
}

void VolumeCount::State::rasterise(const Tile& tile) {
  const std::size_t pixels = receivers.size();
  render::grow(*device, receiver_buffer, "volume receivers", pixels * sizeof(gpu::VolumeReceiver));
  render::grow(*device, count_buffer, "volume counts", pixels * sizeof(std::int32_t));
  render::grow(*device, doubt_buffer, "volume doubts", pixels * sizeof(std::uint32_t));
  receiver_buffer->write<gpu::VolumeReceiver>(receivers);
  doubt_buffer->write<std::uint32_t>(doubts);

  gpu::VolumePush push{};
  store(push.eye, samples->camera.eye);
  store(push.apex, faces->apex);
  push.l = volumes.l;
  push.width = samples->width;
  push.first_row = tile.first_row;
  push.row_count = tile.row_count;
  render::Commands commands(*device);
  commands.fill(*count_buffer, static_cast<std::uint32_t>(faces->at_start));
  render::grow(*device, part_buffer, "volume parts",
               std::max<std::size_t>(faces->parts.size(), 1) * sizeof(gpu::VolumePart));
  if (!faces->parts.empty()) part_buffer->write<gpu::VolumePart>(faces->parts);
  const std::size_t most = device->limits().max_storage_buffer_range / sizeof(gpu::VolumeFace);
  for (const VolumeFaces::Kind& kind : faces->kinds) {
    const render::RasterPass& pass = pass_of(kind.kind, faces->before, !faces->parts.empty());
    for (std::size_t first = 0; first < kind.faces.size(); first += most) {
      const std::size_t batch = std::min(most, kind.faces.size() - first);
      render::grow(*device, face_buffer, "volume faces", batch * sizeof(gpu::VolumeFace));
      face_buffer->write<gpu::VolumeFace>(std::span(kind.faces).subspan(first, batch));
      pass.record(commands, push, {*face_buffer, *receiver_buffer, *count_buffer, *doubt_buffer, *part_buffer},
                  {.width = samples->width,
                   .height = tile.row_count,
                   .vertices = 4,
                   .instances = static_cast<std::uint32_t>(batch)});
      times.add(commands.submit());
    }
  }
  commands.submit();  // runs the fill if there was no face
  counts.resize(pixels);
  count_buffer->read<std::int32_t>(counts);
  doubt_buffer->read<std::uint32_t>(doubts);
  for (std::uint32_t& word : doubts) {
    totals.updates += word & ~gpu::kDoubtBit;
    word = word >> 31;
  }
}

std::int32_t VolumeCount::State::count_exactly(std::size_t pixel) const {
  const auto carrier = static_cast<std::uint32_t>(samples->triangle[pixel]);
  const glm::vec3 &p = samples->p[pixel], &l = volumes.l;
  std::int32_t count = 0;
  tree->for_each_near(glm::min(p, l), glm::max(p, l), [&](std::uint32_t triangle) {
    if (!volumes.left_out.empty() && volumes.left_out[triangle] != 0) return;
    if (!visibility::may_occlude(*scene, *light, carrier, triangle)) return;
    count += visibility::segment_meets_triangle(p, l, scene->corners(triangle), *light).meets ? 1 : 0;
  });
  return count - faces->at_eye;
}

void VolumeCount::State::count_doubtful(const Tile& tile) {
  std::vector<std::size_t> doubtful;
  for (std::size_t i = 0; i < doubts.size(); ++i) {
    if (doubts[i] != 0) doubtful.push_back(i);
    if (kinds[i] != Kind::counted) counts[i] = 0;
  }
  totals.doubtful_pixels += doubtful.size();
  if (doubtful.empty()) return;
  if (!tree) tree = visibility::make_triangle_tree(*scene);
  const std::size_t first = std::size_t{tile.first_row} * samples->width;
  tbb::parallel_for(std::size_t{0}, doubtful.size(),
                    [&](std::size_t i) { counts[doubtful[i]] = count_exactly(first + doubtful[i]); });
}

void VolumeCount::count(const Tile& tile) {
  State& s = *state_;
  PENUMBRA_ASSERT(s.light != nullptr && s.samples != nullptr, "count before prepare_light and prepare_view");
  PENUMBRA_ASSERT(tile.first_row + tile.row_count <= s.samples->height, "tile of rows {} + {} in a picture of {}",
                  tile.first_row, tile.row_count, s.samples->height);
  s.counts.clear();
  s.kinds.clear();
  if (tile.row_count == 0 || s.samples->width == 0) return;
  s.find_faces();
  s.classify(tile);
  s.rasterise(tile);
  s.count_doubtful(tile);
  if (s.whole_tiles) s.copy_in_whole_tiles();
  for (const std::int32_t count : s.counts) {
    s.totals.largest_count = std::max(s.totals.largest_count, static_cast<std::uint64_t>(std::max(count, 0)));
  }
}

std::span<const std::int32_t> VolumeCount::counts() const {
  return state_->counts;
}
std::span<const VolumeCount::Kind> VolumeCount::kinds() const {
  return state_->kinds;
}
std::span<const std::uint32_t> VolumeCount::doubts() const {
  return state_->doubts;
}
glm::vec3 VolumeCount::center() const {
  return state_->volumes.l;
}
const ShadowCasters& VolumeCount::casters() const {
  PENUMBRA_ASSERT(state_->casters.has_value(), "casters before prepare_mesh");
  return *state_->casters;
}
const LightVolumes& VolumeCount::volumes() const {
  return state_->volumes;
}
const VolumeCount::Totals& VolumeCount::totals() const {
  return state_->totals;
}
std::vector<visibility::PassTime> VolumeCount::take_pass_times() {
  return state_->times.take();
}
std::uint64_t VolumeCount::memory_bytes() const {
  const State& s = *state_;
  std::uint64_t bytes = 0;
  for (const auto* buffer : {&s.face_buffer, &s.receiver_buffer, &s.count_buffer, &s.doubt_buffer, &s.part_buffer}) {
    if (*buffer) bytes += (*buffer)->bytes();
  }
  return bytes;
}

}  // namespace penumbra::volumes
