// SPDX-License-Identifier: Apache-2.0
// Sorts casters into light-space slices: equally thick (Eisemann and Décoret 2006), or one plane (Soler and Sillion
// 1998).

#include "maps/products/slices.hpp"

#include "maps/host/caster.vert.glsl.hpp"
#include "maps/host/caster.vert.spv.hpp"
#include "maps/host/caster_holes.vert.glsl.hpp"
#include "maps/host/caster_holes.vert.spv.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/products/slices.frag.glsl.hpp"
#include "maps/products/slices.frag.spv.hpp"
#include "maps/products/slices_holes.frag.glsl.hpp"
#include "maps/products/slices_holes.frag.spv.hpp"
#include "maps/products/slices_moved.comp.spv.hpp"
#include "visibility/receivers.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::maps {
namespace {

/// Relative margin of the end of a slice beyond its plane: a surface in the plane is in the slice, whatever the
/// rasteriser's interpolation of its depth.
constexpr double kBeyondPlane = 0x1p-14;

bool casts(const MapSet& maps, std::uint32_t triangle) {
  return maps.scene.casts_shadow[triangle] != 0 && maps.scene.emits[triangle] != maps.light.index;
}

/// Twice the area of a triangle seen along the light's normal, and three times its mean height over the light's plane.
struct Facing {
  double area, height;
};
Facing facing(const visibility::SceneFloats& scene, const LightBasis& basis, std::uint32_t triangle) {
  const auto corners = scene.corners(triangle);
  const glm::dvec3 a = basis.local(corners[0]), b = basis.local(corners[1]), c = basis.local(corners[2]);
  return {std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)), a.z + b.z + c.z};
}

struct Range {
  double nearest = std::numeric_limits<double>::infinity(), deepest = 0;
};
/// Returns the range of heights of the triangles accepted by `counts`, on one side of the light's plane.
template <typename Counts>
Range heights(const MapSet& maps, double sign, const Counts& counts) {
  Range range;
  for (std::uint32_t i = 0; i < maps.scene.triangles.size(); ++i) {
    if (!counts(i)) continue;
    Range own{range.nearest, 0};
    for (const glm::vec3& corner : maps.scene.corners(i)) {
      const double height = std::max(sign * maps.basis.local(corner).z, 0.0);
      own.nearest = std::min(own.nearest, height);
      own.deepest = std::max(own.deepest, height);
    }
    if (own.deepest == 0) continue;  // wholly on the other side
    range.nearest = own.nearest;
    range.deepest = std::max(range.deepest, own.deepest);
  }
  return range;
}

}  // namespace

std::uint32_t ground_of(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis) {
  std::vector<double> areas;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (!visibility::is_receiver(scene, light, i)) continue;
    if (scene.plane[i] != visibility::SceneFloats::kNoPlane && scene.casts_shadow[i] == 0) return kNoObject;
    areas.resize(std::max<std::size_t>(areas.size(), scene.object[i] + std::size_t{1}), 0.0);
    areas[scene.object[i]] += facing(scene, basis, i).area;
  }
  const auto largest = std::ranges::max_element(areas);
  return largest == areas.end() || *largest == 0 ? kNoObject : static_cast<std::uint32_t>(largest - areas.begin());
}

gpu::SlicePlanes slice_planes(const MapSet& maps, SliceRule rule, std::uint32_t count) {
  gpu::SlicePlanes planes{.count = count, .limit = {}, .plane = {}};
  const std::uint32_t ground = rule == SliceRule::one_plane ? ground_of(maps.scene, maps.light, maps.basis) : kNoObject;
  for (std::size_t s = 0; s < 2; ++s) {
    const double sign = s == 0 ? 1 : -1;
    const auto set = [&](std::uint32_t k, double plane, double limit) {
      planes.plane[s][k] = static_cast<float>(plane);
      planes.limit[s][k] = static_cast<float>(limit);
    };
    if (rule == SliceRule::one_plane) {
      double area = 0, moment = 0, corners = 0, sum = 0;
      for (std::uint32_t i = 0; i < maps.scene.triangles.size(); ++i) {
        const Facing seen = facing(maps.scene, maps.basis, i);
        if (!casts(maps, i) || maps.scene.object[i] == ground || sign * seen.height <= 0) continue;
        area += seen.area;
        moment += seen.area * sign * seen.height / 3;
        corners += 1;
        sum += sign * seen.height / 3;
      }
      // If all casters are seen edge-on, the mean of the triangles' heights is used.
      const double mean = area > 0 ? moment / area : corners > 0 ? sum / corners : 1.0;
      set(0, mean, std::numeric_limits<float>::max());
      continue;
    }
    const Range casters = heights(maps, sign, [&](std::uint32_t i) { return casts(maps, i); });
    const Range receivers =
        heights(maps, sign, [&](std::uint32_t i) { return visibility::is_receiver(maps.scene, maps.light, i); });
    const double first = std::min(casters.nearest, receivers.deepest),
                 last = std::max(first, std::min(casters.deepest, receivers.deepest));
    for (std::uint32_t k = 0; k < count; ++k) {
      const double plane = first + (last - first) * (k + 1.0) / count;
      set(k, plane, plane * (1 + kBeyondPlane));
    }
  }
  return planes;
}

Slices::Slices(const render::Device& device, const SliceOptions& options)
    : device_(&device), options_(options), planes_(device, "slice planes", sizeof(gpu::SlicePlanes)) {
  if (options.depth != DepthUse::first) {
    moved_.emplace(device, render::ComputePassOptions{.name = "slices of shadows",
                                                      .spirv = shaders::kSlicesMovedComp,
                                                      .push_bytes = sizeof(gpu::MovedPush),
                                                      .constants = {}});
  }
  if (options.rasteriser == Rasteriser::opengl) {
    opengl_passes_.emplace(OpenGlPasses{
        {device.opengl(), {.name = "slices", .vertex = shaders::kCasterVertText, .fragment = shaders::kSlicesFragText}},
        {device.opengl(),
         {.name = "slices with holes",
          .vertex = shaders::kCasterHolesVertText,
          .fragment = shaders::kSlicesHolesFragText}}});
  } else {
    passes_.emplace(Passes{{device,
                            {.name = "slices",
                             .vertex = shaders::kCasterVert,
                             .fragment = shaders::kSlicesFrag,
                             .push_bytes = sizeof(gpu::SlicesPush)}},
                           {device,
                            {.name = "slices with holes",
                             .vertex = shaders::kCasterHolesVert,
                             .fragment = shaders::kSlicesHolesFrag,
                             .push_bytes = sizeof(gpu::SlicesPush)}}});
  }
}

void Slices::upload(const MapSet& maps) {
  const std::uint32_t ground =
      options_.rule == SliceRule::one_plane ? ground_of(maps.scene, maps.light, maps.basis) : kNoObject;
  casters_.clear();
  upload_casters(maps, ground, nullptr);
  const HoleSurfaces surfaces(maps.scene);
  if (opengl_passes_) {
    opengl_surfaces_.emplace(device_->opengl(), "surfaces with holes", std::span(surfaces.words()).size_bytes());
    opengl_surfaces_->write<std::uint32_t>(surfaces.words());
  } else {
    surfaces_ = render::make_buffer<std::uint32_t>(*device_, "surfaces with holes", surfaces.words());
  }
  upload_casters(maps, ground, &surfaces);
}

void Slices::upload_casters(const MapSet& maps, std::uint32_t ground, const HoleSurfaces* surfaces) {
  const std::uint64_t room =
      opengl_passes_ ? device_->opengl().info().max_storage_block : device_->limits().max_storage_buffer_range;
  const std::size_t most = room / (3 * gpu::kPlaceWords * sizeof(std::uint32_t)) * 3;
  std::vector<glm::vec3> corners;
  std::vector<std::uint32_t> places;
  const auto flush = [&] {
    if (corners.empty()) return;
    Casters& batch = casters_.emplace_back();
    batch.vertices = static_cast<std::uint32_t>(corners.size());
    batch.holes = surfaces != nullptr;
    if (opengl_passes_) {
      batch.opengl_corners.emplace(device_->opengl(), "slice casters", corners.size() * sizeof(glm::vec3));
      batch.opengl_corners->write<glm::vec3>(corners);
      if (batch.holes) {
        batch.opengl_places.emplace(device_->opengl(), "places of casters", std::span(places).size_bytes());
        batch.opengl_places->write<std::uint32_t>(places);
      }
    } else {
      batch.corners = render::make_buffer<glm::vec3>(*device_, "slice casters", corners);
      if (batch.holes) batch.places = render::make_buffer<std::uint32_t>(*device_, "places of casters", places);
    }
    corners.clear();
    places.clear();
  };
  for (std::uint32_t i = 0; i < maps.scene.triangles.size(); ++i) {
    if (!casts(maps, i) || maps.scene.object[i] == ground) continue;
    if (has_holes(maps.scene, i) != (surfaces != nullptr)) continue;
    for (const glm::vec3& corner : maps.scene.corners(i)) corners.push_back(corner);
    if (surfaces != nullptr) surfaces->add_corners(i, places);
    if (corners.size() == most) flush();
  }
  flush();
}

std::vector<gpu::SlicesPush> Slices::faces_of(const MapSet& maps) const {
  gpu::LightView view{};
  maps.views.read<gpu::LightView>(std::span(&view, 1));
  std::vector<gpu::SlicesPush> faces;
  for (std::uint32_t face = 0; face < maps.faces; ++face) {
    const std::uint32_t side = face >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
    faces.push_back({.face = face_push(view, maps.basis, face),
                     .size = maps.size,
                     .first = face * maps.size * maps.size,
                     .side = side,
                     .sideways = face != view.side[side].first_face ? 1U : 0U});
  }
  return faces;
}

void Slices::record(render::Commands& commands, const MapSet& maps) {
  const std::uint64_t texels = std::uint64_t{maps.size} * maps.size;
  render::grow(*device_, bits_, "slices", std::max(maps.faces, 1U) * texels * sizeof(std::uint32_t));
  const gpu::SlicePlanes planes = slice_planes(maps, options_.rule, options_.count);
  planes_.write<gpu::SlicePlanes>(std::span(&planes, 1));
  upload(maps);
  if (opengl_passes_) {
    commands.host_pass("slices (OpenGL)", [&] { draw_by_opengl(maps, planes); });
  } else {
    commands.fill(*bits_, 0);
    for (const gpu::SlicesPush& push : faces_of(maps)) {
      for (const Casters& casters : casters_) {
        const render::RasterPass::Draw draw{.width = maps.size, .height = maps.size, .vertices = casters.vertices};
        if (casters.holes) {
          passes_->holes.record(commands, push, {*casters.corners, *casters.places, *surfaces_, planes_, *bits_}, draw);
        } else {
          passes_->solid.record(commands, push, {*casters.corners, planes_, *bits_}, draw);
        }
      }
    }
  }
  if (moved_ && maps.faces > 0) move_nearest(commands, maps);
}

void Slices::move_nearest(render::Commands& commands, const MapSet& maps) {
  const std::uint32_t ground =
      options_.rule == SliceRule::one_plane ? ground_of(maps.scene, maps.light, maps.basis) : kNoObject;
  const render::Buffer* layers = &maps.depths;
  if (ground != kNoObject) {
    visibility::SceneFloats blockers = maps.scene;
    for (std::uint32_t i = 0; i < blockers.triangles.size(); ++i) {
      if (blockers.object[i] == ground) blockers.casts_shadow[i] = 0;
    }
    if (!blocker_maps_) blocker_maps_.emplace(*device_, maps.size, options_.rasteriser);
    blocker_maps_->upload(blockers);
    render::grow(*device_, blocker_depths_, "layers of blockers",
                 std::uint64_t{2} * maps.faces * maps.size * maps.size * sizeof(float));
    gpu::LightView view{};
    maps.views.read<gpu::LightView>(std::span(&view, 1));
    blocker_maps_->record(commands, view, maps.basis, maps.light.index, *blocker_depths_, 0);
    blocker_maps_->record_behind(commands, view, maps.basis, maps.light.index, *blocker_depths_, maps.faces, 0);
    layers = blocker_depths_.get();
  }
  const gpu::MovedPush push{maps.size, maps.faces, static_cast<std::uint32_t>(options_.depth),
                            static_cast<float>(options_.bias)};
  const std::uint64_t texels = std::uint64_t{maps.faces} * maps.size * maps.size;
  moved_->record(commands, push, {*layers, maps.views, planes_, *bits_}, (texels + 63) / 64);
}

void Slices::draw_by_opengl(const MapSet& maps, const gpu::SlicePlanes& planes) const {
  const render::opengl::Context& context = device_->opengl();
  const render::opengl::Buffer heights(context, "slice planes", sizeof planes);
  heights.write<gpu::SlicePlanes>(std::span(&planes, 1));
  std::vector<std::uint32_t> words(bits_->bytes() / sizeof(std::uint32_t), 0);
  const render::opengl::Buffer bits(context, "slices", bits_->bytes());
  bits.write<std::uint32_t>(words);
  for (const gpu::SlicesPush& push : faces_of(maps)) {
    for (const Casters& casters : casters_) {
      const render::opengl::RasterPass::Draw draw{
          .width = maps.size, .height = maps.size, .vertices = casters.vertices};
      if (casters.holes) {
        opengl_passes_->holes.draw(
            push, {*casters.opengl_corners, *casters.opengl_places, *opengl_surfaces_, heights, bits}, draw);
      } else {
        opengl_passes_->solid.draw(push, {*casters.opengl_corners, heights, bits}, draw);
      }
    }
  }
  bits.read<std::uint32_t>(words);
  bits_->write<std::uint32_t>(words);
}

std::uint64_t Slices::memory_bytes() const {
  const std::uint64_t casters =
      std::accumulate(casters_.begin(), casters_.end(), std::uint64_t{0},
                      [](std::uint64_t sum, const Casters& batch) { return sum + batch.vertices * sizeof(glm::vec3); });
  const std::uint64_t layers =
      (blocker_maps_ ? blocker_maps_->memory_bytes() : 0) + (blocker_depths_ ? blocker_depths_->bytes() : 0);
  return casters + layers + planes_.bytes() + (bits_ ? bits_->bytes() : 0);
}

}  // namespace penumbra::maps
