// SPDX-License-Identifier: Apache-2.0
// Renders depth maps of casters (Williams 1978), layers behind others by depth peeling (Everitt 2001).

#include "maps/host/caster_maps.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "maps/host/caster.frag.spv.hpp"
#include "maps/host/caster.vert.spv.hpp"
#include "maps/host/caster_holes.frag.spv.hpp"
#include "maps/host/caster_holes.vert.spv.hpp"
#include "maps/host/logarithmic.frag.spv.hpp"
#include "maps/host/logarithmic.vert.spv.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/host/peel.frag.spv.hpp"
#include "maps/host/peel_holes.frag.spv.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

namespace penumbra::maps {

namespace {

render::RasterPassOptions pass_options(std::string name, bool holes,
                                       render::DepthCompare compare = render::DepthCompare::less) {
  if (holes) name += " with holes";
  return {.name = std::move(name),
          .vertex = holes ? std::span<const std::uint32_t>(shaders::kCasterHolesVert) : shaders::kCasterVert,
          .fragment = holes ? std::span<const std::uint32_t>(shaders::kCasterHolesFrag) : shaders::kCasterFrag,
          .push_bytes = sizeof(gpu::CasterPush),
          .constants = {},
          .depth = true,
          .compare = compare};
}

render::RasterPassOptions behind_options(bool holes) {
  render::RasterPassOptions options = pass_options("peel maps", holes);
  options.fragment = holes ? std::span<const std::uint32_t>(shaders::kPeelHolesFrag) : shaders::kPeelFrag;
  options.push_bytes = sizeof(gpu::PeelPush);
  return options;
}

/// Returns the depth of empty texels.
float nothing(MapLayer layer) {
  return layer == MapLayer::farthest ? 0.0F : 1.0F;
}

std::vector<FacePush> pushes(const gpu::LightView& view, const LightBasis& basis) {
  std::vector<FacePush> faces(view.side[0].face_count + view.side[1].face_count);
  for (std::uint32_t face = 0; face < faces.size(); ++face) faces[face].plain = face_push(view, basis, face);
  return faces;
}

const char* pass_name(MapLayer layer) {
  switch (layer) {
    case MapLayer::nearest:
      return "render maps (OpenGL)";
    case MapLayer::behind:
      return "peel maps (OpenGL)";
    case MapLayer::farthest:
      return "render farthest (OpenGL)";
  }
  return "render maps (OpenGL)";
}

}  // namespace

CasterMaps::Passes::Passes(const render::Device& device, bool holes)
    : nearest(device, pass_options("render maps", holes)),
      behind(device, behind_options(holes)),
      farthest(device, pass_options("render farthest", holes, render::DepthCompare::greater)) {}

const render::RasterPass& CasterMaps::Passes::logarithmic_faces(const render::Device& device) const {
  if (!logarithmic) {
    render::RasterPassOptions options = pass_options("render logarithmic maps", false);
    options.vertex = shaders::kLogarithmicVert;
    options.fragment = shaders::kLogarithmicFrag;
    options.push_bytes = sizeof(gpu::LogarithmicPush);
    logarithmic.emplace(device, options);
  }
  return *logarithmic;
}

const render::RasterPass& CasterMaps::Passes::of(MapLayer layer) const {
  return layer == MapLayer::nearest ? nearest : layer == MapLayer::behind ? behind : farthest;
}

CasterMaps::CasterMaps(const render::Device& device, std::uint32_t size, Rasteriser rasteriser)
    : device_(&device), size_(size) {
  if (rasteriser == Rasteriser::opengl) {
    opengl_ = std::make_unique<OpenGlMaps>(device.opengl(), size);
  } else {
    solid_.emplace(device, false);
    target_.emplace(device, "shadow map", size, size);
  }
}

void CasterMaps::pass(const visibility::AllTriangles& all, visibility::PassTimes& times) {
  PENUMBRA_ASSERT(!opengl_, "OpenGL draws only uploaded triangles, not those that are passed in parts");
  all_ = &all;
  times_ = &times;
  batches_.clear();
  emits_.clear();
}

void CasterMaps::upload(const visibility::SceneFloats& scene) {
  all_ = nullptr;
  passing_.reset();
  std::vector<std::uint32_t> casters;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] != 0) casters.push_back(i);
  }
  std::ranges::stable_sort(casters, {}, [&](std::uint32_t i) { return scene.emits[i]; });
  const auto holes =
      std::stable_partition(casters.begin(), casters.end(), [&](std::uint32_t i) { return !has_holes(scene, i); });
  emits_.resize(casters.size());
  std::transform(casters.begin(), casters.end(), emits_.begin(), [&](std::uint32_t i) { return scene.emits[i]; });

  batches_.clear();
  if (opengl_) opengl_->forget();
  add_batches(scene, {casters.begin(), holes}, nullptr);
  if (holes == casters.end()) return;
  const HoleSurfaces surfaces(scene);
  if (opengl_) {
    opengl_->set_surfaces(surfaces.words());
  } else {
    surfaces_ = render::make_buffer<std::uint32_t>(*device_, "surfaces with holes", surfaces.words());
    if (!holes_) holes_.emplace(*device_, true);
  }
  add_batches(scene, {holes, casters.end()}, &surfaces);
}

void CasterMaps::add_batches(const visibility::SceneFloats& scene, std::span<const std::uint32_t> casters,
                             const HoleSurfaces* surfaces) {
  const std::size_t corner_bytes =
      surfaces != nullptr ? std::max(sizeof(glm::vec3), gpu::kPlaceWords * sizeof(std::uint32_t)) : sizeof(glm::vec3);
  const std::uint64_t room =
      opengl_ ? device_->opengl().info().max_storage_block : device_->limits().max_storage_buffer_range;
  const std::size_t most = room / (3 * corner_bytes);
  for (std::size_t first = 0; first < casters.size(); first += most) {
    const std::size_t count = std::min(most, casters.size() - first);
    std::vector<glm::vec3> corners;
    std::vector<std::uint32_t> places;
    corners.reserve(3 * count);
    for (const std::uint32_t caster : casters.subspan(first, count)) {
      for (const glm::vec3& corner : scene.corners(caster)) corners.push_back(corner);
      if (surfaces != nullptr) surfaces->add_corners(caster, places);
    }
    const std::uint32_t before = batches_.empty() ? 0 : batches_.back().first + batches_.back().count;
    Batch& batch = batches_.emplace_back();
    batch.first = before;
    batch.count = static_cast<std::uint32_t>(count);
    batch.holes = surfaces != nullptr;
    if (opengl_) {
      opengl_->add(corners, places);
      continue;
    }
    batch.corners = render::make_buffer<glm::vec3>(*device_, "map casters", corners);
    if (batch.holes) batch.places = render::make_buffer<std::uint32_t>(*device_, "places of casters", places);
  }
}

std::vector<CasterMaps::Range> CasterMaps::ranges(const Batch& batch, std::int32_t light_index) const {
  const auto first = emits_.begin() + batch.first, last = first + batch.count;
  const auto [body, rest] = std::equal_range(first, last, light_index);
  std::vector<Range> ranges;
  for (const auto& [from, to] : {std::pair(first, body), std::pair(rest, last)}) {
    if (from != to) ranges.push_back({static_cast<std::uint32_t>(from - first), static_cast<std::uint32_t>(to - from)});
  }
  return ranges;
}

gpu::CasterPush CasterMaps::offset(gpu::CasterPush push) const {
  push.offset_factor = offset_factor_;
  push.offset_units = offset_units_;
  return push;
}

void CasterMaps::record_faces(render::Commands& commands, MapLayer layer, std::span<const FacePush> faces,
                              std::int32_t light_index, const Destination& to) const {
  if (!opengl_) {
    for (std::uint32_t face = 0; face < faces.size(); ++face) {
      record_on_device(commands, layer, faces[face], light_index, face, to);
    }
    return;
  }
  if (faces.empty()) return;
  commands.host_pass(pass_name(layer), [&] {
    for (std::uint32_t face = 0; face < faces.size(); ++face) {
      PENUMBRA_ASSERT(!faces[face].logarithmic, "OpenGL does not draw logarithmic faces");
      draw_by_opengl(layer, offset(faces[face].plain), light_index, face, to);
    }
  });
}

void CasterMaps::record_on_device(render::Commands& commands, MapLayer layer, const FacePush& push,
                                  std::int32_t light_index, std::uint32_t face, const Destination& to) const {
  const std::uint64_t face_texels = std::uint64_t{size_} * size_, face_bytes = face_texels * sizeof(float);
  const auto previous = static_cast<std::uint32_t>((to.previous_face + face) * face_texels);
  if (all_ != nullptr) return record_passing(commands, layer, push, light_index, face, to);
  bool clear = true;
  for (const Batch& batch : batches_) {
    for (const Range& range : ranges(batch, light_index)) {
      render::RasterPass::Draw draw{
          .width = size_, .height = size_, .vertices = 3 * range.count, .depth = &*target_, .clear = clear};
      clear = false;
      if (push.logarithmic) {
        PENUMBRA_ASSERT(!batch.holes, "logarithmic faces of surfaces with holes");
        gpu::LogarithmicPush words = *push.logarithmic;
        words.first_vertex = 3 * range.first;
        words.peels = layer == MapLayer::behind ? 1 : 0;
        words.previous = previous;
        draw.vertices = 6 * range.count;
        solid_->logarithmic_faces(*device_).record(commands, words, {*batch.corners, to.maps}, draw);
        continue;
      }
      gpu::PeelPush words{offset(push.plain), previous, size_};
      words.face.first_vertex = 3 * range.first;
      const auto push_bytes = std::as_bytes(std::span(&words, 1))
                                  .first(layer == MapLayer::behind ? sizeof(gpu::PeelPush) : sizeof(gpu::CasterPush));
      std::vector<render::BufferReference> buffers{*batch.corners};
      if (batch.holes) buffers.insert(buffers.end(), {*batch.places, *surfaces_});
      if (layer == MapLayer::behind) buffers.emplace_back(to.maps);
      const Passes& passes = batch.holes ? *holes_ : *solid_;
      passes.of(layer).record(commands, push_bytes, buffers, draw);
    }
  }
  if (clear) {  // no object casts shadow: the map is empty
    commands.fill(to.maps, std::bit_cast<std::uint32_t>(nothing(layer)), (to.first_face + face) * face_bytes,
                  face_bytes);
  } else {
    target_->copy_to(commands, to.maps, (to.first_face + face) * face_bytes);
  }
}

/// Depths are minima, or maxima, which do not depend on the order of triangles.
void CasterMaps::record_passing(render::Commands& commands, MapLayer layer, const FacePush& push,
                                std::int32_t light_index, std::uint32_t face, const Destination& to) const {
  PENUMBRA_ASSERT(!push.logarithmic, "logarithmic faces need uploaded triangles, not those that are passed in parts");
  constexpr std::size_t kMost = std::size_t{1} << 20;  // triangles of one draw: 36 MiB
  const std::uint64_t face_texels = std::uint64_t{size_} * size_;
  std::vector<glm::vec3> corners;
  bool clear = true;
  passed_ = 0;
  const auto draw = [&] {
    if (corners.empty()) return;
    render::grow(*device_, passing_, "passing casters", corners.size() * sizeof(glm::vec3));
    passing_->write<glm::vec3>(corners);
    gpu::PeelPush words{offset(push.plain), static_cast<std::uint32_t>((to.previous_face + face) * face_texels), size_};
    words.face.first_vertex = 0;
    const auto push_bytes = std::as_bytes(std::span(&words, 1))
                                .first(layer == MapLayer::behind ? sizeof(gpu::PeelPush) : sizeof(gpu::CasterPush));
    std::vector<render::BufferReference> buffers{*passing_};
    if (layer == MapLayer::behind) buffers.emplace_back(to.maps);
    solid_->of(layer).record(commands, push_bytes, buffers,
                             {.width = size_,
                              .height = size_,
                              .vertices = static_cast<std::uint32_t>(corners.size()),
                              .depth = &*target_,
                              .clear = clear});
    times_->add(commands.submit());  // the buffer is written again
    clear = false;
    corners.clear();
  };
  all_->for_each_run([&](const visibility::AllTriangles::Run& run) {
    if (!run.casts_shadow) return;
    passed_ += run.corners.size();  // casters of the light's own body are counted, too, as in batches
    if (run.emits == light_index) return;
    for (const std::array<glm::vec3, 3>& triangle : run.corners) {
      corners.insert(corners.end(), triangle.begin(), triangle.end());
      if (corners.size() >= 3 * kMost) draw();
    }
  });
  draw();
  if (clear) {
    commands.fill(to.maps, std::bit_cast<std::uint32_t>(nothing(layer)),
                  (to.first_face + face) * face_texels * sizeof(float), face_texels * sizeof(float));
  } else {
    target_->copy_to(commands, to.maps, (to.first_face + face) * face_texels * sizeof(float));
  }
}

void CasterMaps::draw_by_opengl(MapLayer layer, const gpu::CasterPush& push, std::int32_t light_index,
                                std::uint32_t face, const Destination& to) const {
  const std::uint64_t face_texels = std::uint64_t{size_} * size_, face_bytes = face_texels * sizeof(float);
  std::vector<float> texels(face_texels, nothing(layer));
  if (layer == MapLayer::behind) {
    to.maps.read<float>(texels, (to.previous_face + face) * face_bytes);
    opengl_->set_previous(texels);
  }
  bool clear = true;
  for (std::size_t i = 0; i < batches_.size(); ++i) {
    for (const Range& range : ranges(batches_[i], light_index)) {
      opengl_->draw(layer, push, {i, range.first, range.count, clear});
      clear = false;
    }
  }
  if (clear) {
    std::ranges::fill(texels, nothing(layer));
  } else {
    opengl_->read(texels);
  }
  to.maps.write<float>(texels, (to.first_face + face) * face_bytes);
}

void CasterMaps::record(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                        std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face) const {
  record_faces(commands, MapLayer::nearest, pushes(view, basis), light_index, {maps, first_face, 0});
}

void CasterMaps::record_behind(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                               std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face,
                               std::uint64_t previous_face) const {
  record_faces(commands, MapLayer::behind, pushes(view, basis), light_index, {maps, first_face, previous_face});
}

void CasterMaps::record_farthest(render::Commands& commands, const gpu::LightView& view, const LightBasis& basis,
                                 std::int32_t light_index, const render::Buffer& maps, std::uint64_t first_face) const {
  record_faces(commands, MapLayer::farthest, pushes(view, basis), light_index, {maps, first_face, 0});
}

void CasterMaps::record(render::Commands& commands, std::span<const FacePush> faces, std::int32_t light_index,
                        const render::Buffer& maps, std::uint64_t first_face) const {
  record_faces(commands, MapLayer::nearest, faces, light_index, {maps, first_face, 0});
}

void CasterMaps::record_behind(render::Commands& commands, std::span<const FacePush> faces, std::int32_t light_index,
                               const render::Buffer& maps, std::uint64_t first_face,
                               std::uint64_t previous_face) const {
  record_faces(commands, MapLayer::behind, faces, light_index, {maps, first_face, previous_face});
}

std::uint64_t CasterMaps::memory_bytes() const {
  const auto add = [](std::uint64_t sum, const Batch& batch) {
    const std::uint64_t place = batch.holes ? gpu::kPlaceWords * sizeof(std::uint32_t) : 0;
    return sum + std::uint64_t{batch.count} * 3 * (sizeof(glm::vec3) + place);
  };
  const std::uint64_t passing = passing_ ? passing_->bytes() : 0;
  return std::accumulate(batches_.begin(), batches_.end(), std::uint64_t{size_} * size_ * sizeof(float) + passing, add);
}

std::uint64_t faces_per_buffer(const render::Device& device, std::uint32_t size) {
  return device.limits().max_storage_buffer_range / (std::uint64_t{size} * size * sizeof(float));
}

void check_faces_fit(const render::Device& device, std::uint32_t size, std::uint32_t faces) {
  if (faces <= faces_per_buffer(device, size)) return;
  const auto most = std::sqrt(static_cast<double>(device.limits().max_storage_buffer_range) / (sizeof(float) * faces));
  throw ResourceError(
      "method option size={}: this light needs {} maps at once, more than one buffer of {} can hold; take "
      "size={} or less",
      size, faces, device.info().name, static_cast<std::uint32_t>(most));
}

}  // namespace penumbra::maps
