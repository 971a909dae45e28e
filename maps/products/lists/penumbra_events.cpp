// SPDX-License-Identifier: Apache-2.0
// Builds penumbra deep shadow maps: V as a function of depth in each texel (St-Amour, Paquette and Poulin 2005), in
// bands of texels.

#include "maps/products/lists/penumbra_events.hpp"

#include "base/error.hpp"
#include "maps/products/lists/nearest_depths.comp.spv.hpp"
#include "maps/products/lists/penumbra_compress.comp.spv.hpp"
#include "maps/products/lists/penumbra_copy.comp.spv.hpp"
#include "maps/products/lists/penumbra_events.shared.h"
#include "maps/products/lists/penumbra_walk.comp.spv.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::maps {
namespace {

/// Memory of all events of a band.
constexpr std::uint64_t kBandBytes = std::uint64_t{64} << 20;

/// Returns the height over the light's plane of the nearest corner of a caster, on either side; at least the smallest
/// depth of maps.
glm::vec2 nearest_casters(const MapSource& source) {
  const float least = source.centre.far * 0x1p-20F;
  glm::vec2 nearest(source.centre.far);
  for (std::size_t i = 0; i < source.scene.triangles.size(); ++i) {
    if (source.scene.casts_shadow[i] == 0 || source.scene.emits[i] == source.light.index) continue;
    glm::vec2 lowest(source.centre.far);
    for (const glm::vec3& corner : source.scene.corners(static_cast<std::uint32_t>(i))) {
      const auto height = static_cast<float>(source.basis.local(corner).z);
      lowest = glm::min(lowest, glm::vec2(height, -height));
    }
    // A triangle that crosses the plane counts with the smallest depth; a triangle behind the plane has no part on this
    // side.
    for (int s = 0; s < 2; ++s) {
      if (lowest[1 - s] < -least || lowest[s] > least) nearest[s] = std::min(nearest[s], std::max(lowest[s], least));
    }
  }
  return nearest * 0.999F;
}

std::uint64_t groups_of(std::uint32_t texels) {
  return (std::uint64_t{texels} + gpu::kLookupGroup - 1) / gpu::kLookupGroup;
}

}  // namespace

PenumbraEvents::PenumbraEvents(const render::Device& device, double bound)
    : device_(&device),
      bound_(bound),
      samples_(device),
      find_nearest_(device, {.name = "nearest depths",
                             .spirv = shaders::kNearestDepthsComp,
                             .push_bytes = sizeof(gpu::NearestDepthsPush),
                             .constants = {}}),
      walk_(device, {.name = "walk maps",
                     .spirv = shaders::kPenumbraWalkComp,
                     .push_bytes = sizeof(gpu::EventsPush),
                     .constants = {}}),
      compress_(device, {.name = "compress events",
                         .spirv = shaders::kPenumbraCompressComp,
                         .push_bytes = sizeof(gpu::CompressPush),
                         .constants = {}}),
      copy_(device, {.name = "gather steps",
                     .spirv = shaders::kPenumbraCopyComp,
                     .push_bytes = sizeof(gpu::CopyStepsPush),
                     .constants = {}}) {}

void PenumbraEvents::make(const MapSource& source) {
  samples_.make(source);
  render::grow(*device_, centre_, "centre's view", sizeof(gpu::LightView));
  centre_->write<gpu::LightView>(std::span(&source.centre, 1));
  render::grow(*device_, most_, "most events", sizeof(std::uint32_t));
  find_nearest(source);

  const std::uint32_t texels = source.faces * source.size * source.size;
  const glm::vec2 nearest = nearest_casters(source);
  std::vector<std::uint32_t> begins{0};
  std::vector<glm::uvec2> steps;
  std::uint32_t capacity = 2 * samples_.count() + 2;
  std::uint64_t events = 0;
  for (std::uint32_t first = 0; first < texels;) {
    const std::uint64_t texel_bytes = std::uint64_t{capacity} * sizeof(glm::uvec2);
    const std::uint64_t most_texels = std::min(kBandBytes, device_->limits().max_storage_buffer_range) / texel_bytes;
    const auto band =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(texels - first, std::max<std::uint64_t>(most_texels, 1)));
    render::grow(*device_, events_, "events", band * texel_bytes);
    render::grow(*device_, counts_, "event counts", band * sizeof(std::uint32_t));
    render::Commands commands(*device_);
    commands.fill(*most_, 0);
    // Drivers for processors end all loops of a workgroup after 65,535 iterations: the number of samples at once is
    // limited accordingly.
    const std::uint32_t at_once = std::max(60000 / (std::max(samples_.faces(), 1u) * (2 * source.size + 2)), 1u);
    std::uint32_t recorded = 0;
    for (const SampleMaps::Part& part : samples_.parts(at_once)) {
      const gpu::EventsPush push{.basis = source.basis.rounded(),
                                 .size = source.size,
                                 .faces = source.faces,
                                 .first_texel = first,
                                 .texel_count = band,
                                 .capacity = capacity,
                                 .first_point = part.first,
                                 .first_map = part.first_map,
                                 .point_count = part.count,
                                 .sample_faces = samples_.faces(),
                                 .nearest = nearest};
      walk_.record(commands, push,
                   {*centre_, samples_.views(), *part.maps, samples_.weights(), *events_, *counts_, *most_, *nearest_},
                   groups_of(band));
      if (++recorded % 96 == 0) source.times.add(commands.submit());
    }
    source.times.add(commands.submit());
    std::uint32_t most = 0;
    most_->read<std::uint32_t>(std::span(&most, 1));
    if (most > capacity) {  // repeats the band with sufficient capacity
      capacity = most;
      continue;
    }
    const std::vector<std::uint32_t> counts = compress(source, band, capacity);
    for (const std::uint32_t count : counts) begins.push_back(begins.back() + count);
    const std::vector<glm::uvec2> more = gather(source, counts, capacity);
    steps.insert(steps.end(), more.begin(), more.end());
    events = std::max<std::uint64_t>(events, most);
    first += band;
    const std::uint64_t bytes = begins.size() * sizeof(std::uint32_t) + steps.size() * sizeof(glm::uvec2);
    if (bytes > device_->limits().max_storage_buffer_range) {
      const double share = static_cast<double>(first) / texels;
      const double fits = std::sqrt(share) * source.size;  // assumes lists of the same length elsewhere
      throw ResourceError(
          "deep-penumbra: its steps of depth do not fit into one buffer of {}; take size={} or less, a larger bound or "
          "fewer --light-samples",
          device_->info().name, std::max(8u, static_cast<std::uint32_t>(fits)));
    }
  }
  std::vector<std::uint32_t> words = begins;
  for (const glm::uvec2& step : steps) {
    words.push_back(step.x);
    words.push_back(step.y);
  }
  render::grow(*device_, lists_, "steps of depth", words.size() * sizeof(std::uint32_t));
  lists_->write<std::uint32_t>(words);
  source.counters["steps"] = steps.size();
  source.counters["mostEventsOfATexel"] = events;
}

void PenumbraEvents::find_nearest(const MapSource& source) {
  render::grow(*device_, nearest_, "nearest depths", std::uint64_t{samples_.count()} * sizeof(std::uint32_t));
  render::Commands commands(*device_);
  commands.fill(*nearest_, ~0U);
  if (samples_.faces() == 0) return static_cast<void>(commands.submit());
  for (const SampleMaps::Part& part : samples_.parts()) {
    const gpu::NearestDepthsPush push{.size = source.size,
                                      .first_point = part.first,
                                      .first_map = part.first_map,
                                      .point_count = part.count,
                                      .sample_faces = samples_.faces()};
    find_nearest_.record(commands, push, {*part.maps, *nearest_},
                         groups_of(part.count * samples_.faces() * source.size));
    source.times.add(commands.submit());
  }
}

std::vector<std::uint32_t> PenumbraEvents::compress(const MapSource& source, std::uint32_t texels,
                                                    std::uint32_t capacity) {
  const gpu::CompressPush push{.texel_count = texels,
                               .capacity = capacity,
                               .total = samples_.total(),
                               .tolerance = static_cast<std::uint32_t>(2 * bound_ * samples_.total())};
  render::Commands commands(*device_);
  commands.fill(*most_, 0);
  compress_.record(commands, push, {*events_, *counts_, *most_}, groups_of(texels));
  source.times.add(commands.submit());
  std::uint32_t ended = 0;
  most_->read<std::uint32_t>(std::span(&ended, 1));
  if (ended != 0) {
    throw ResourceError(
        "deep-penumbra: there are up to {} events on a ray, more than {} can sort before it ends a loop; take fewer "
        "--light-samples or a smaller size",
        capacity, device_->info().name);
  }
  std::vector<std::uint32_t> counts(texels);
  counts_->read<std::uint32_t>(counts);
  return counts;
}

std::vector<glm::uvec2> PenumbraEvents::gather(const MapSource& source, std::span<const std::uint32_t> counts,
                                               std::uint32_t capacity) {
  std::vector<std::uint32_t> offsets(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0u);
  std::vector<glm::uvec2> steps(std::size_t{offsets.back()} + counts.back());
  if (steps.empty()) return steps;
  render::grow(*device_, offsets_, "offsets of steps", offsets.size() * sizeof(std::uint32_t));
  render::grow(*device_, steps_, "steps of a band", steps.size() * sizeof(glm::uvec2));
  offsets_->write<std::uint32_t>(offsets);
  render::Commands commands(*device_);
  const auto texels = static_cast<std::uint32_t>(counts.size());
  copy_.record(commands, gpu::CopyStepsPush{texels, capacity}, {*events_, *counts_, *offsets_, *steps_},
               groups_of(texels));
  source.times.add(commands.submit());
  steps_->read<glm::uvec2>(steps);
  return steps;
}

std::uint64_t PenumbraEvents::memory_bytes() const {
  std::uint64_t bytes = samples_.memory_bytes();
  for (const auto* buffer : {&centre_, &nearest_, &events_, &counts_, &most_, &offsets_, &steps_, &lists_})
    bytes += *buffer ? (*buffer)->bytes() : 0;
  return bytes;
}

}  // namespace penumbra::maps
