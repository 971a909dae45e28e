// SPDX-License-Identifier: Apache-2.0
// The host's half of silhouette_*.comp and wedge_build.comp: silhouettes and penumbra wedges on the device or the host.
// docs/wedges.md, On the device.

#include "volumes/raster/wedge_builder.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/compute_pass.hpp"
#include "volumes/wedges/light_hull.hpp"
#include "volumes/edges/device/silhouette_pass.hpp"
#include "volumes/raster/wedge_build.comp.spv.hpp"
#include "volumes/raster/wedge_build.shared.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::SceneFloats;

std::vector<WedgeEdge> wedge_edges(const std::vector<VolumeEdge>& edges, const std::vector<std::uint32_t>& which) {
  std::vector<WedgeEdge> result;
  for (const std::uint32_t i : which) result.push_back({edges[i].a, edges[i].b, {}});
  return result;
}

Wedge wedge_of(const gpu::BuiltWedge& built, const VolumeEdge& edge, std::size_t source) {
  Wedge wedge{edge.a, edge.b, WedgeOutcome::wedge, {}, std::nullopt, static_cast<std::uint32_t>(source)};
  wedge.planes.reserve(gpu::kBuiltPlanes);
  for (const auto& [a, b, c, d] : built.planes) wedge.planes.push_back({a, b, c, d});
  return wedge;
}

/// Returns the device's wedges, with the host's in place of those without a proof.
std::vector<Wedge> merged(const std::vector<VolumeEdge>& edges, const std::vector<gpu::BuiltWedge>& built,
                          const std::vector<std::uint32_t>& missing, std::vector<Wedge> hosts) {
  std::vector<Wedge> wedges(edges.size() - missing.size() + hosts.size());
  std::vector<std::size_t> place(edges.size() + 1);  // for each edge, its first wedge
  for (const Wedge& wedge : hosts) ++place[missing[wedge.source] + 1];
  for (std::size_t i = 0; i < edges.size(); ++i) place[i + 1] += place[i] + built[i].proved;
  for_each_index(edges.size(), [&](std::size_t i) {
    if (built[i].proved != 0) wedges[place[i]] = wedge_of(built[i], edges[i], i);
  });
  for (std::size_t j = 0; j < hosts.size();) {
    const std::size_t first = j;  // range of one edge's pieces
    const std::uint32_t which = hosts[first].source, source = missing[which];
    for (; j < hosts.size() && hosts[j].source == which; ++j) {
      Wedge& wedge = wedges[place[source] + (j - first)] = std::move(hosts[j]);
      wedge.source = source;
      if (wedge.parent) *wedge.parent += static_cast<std::uint32_t>(place[source] - first);
    }
  }
  return wedges;
}

}  // namespace

struct WedgeBuilder::State {
  /// Objects that only the device needs.
  struct Device {
    Device(const render::Device& on, std::uint64_t most_bytes)
        : silhouettes(on, most_bytes),
          build(on,
                {.name = "wedge build", .spirv = shaders::kWedgeBuildComp, .push_bytes = sizeof(gpu::WedgeBuildPush)}),
          commands(on) {}

    SilhouettePass silhouettes;
    render::ComputePass build;
    render::Commands commands;
    std::unique_ptr<render::Buffer> corners, wedges;
    visibility::PassTimes times;
    bool holds_mesh = false;
  };

  State(const render::Device& device, const Options& asked) : on(&device), options(asked) {
    if (options.on == WedgesOn::device) gpu.emplace(device, options.most_bytes);
  }

  [[nodiscard]] std::vector<gpu::BuiltWedge> build_on_device(const LightHull& hull);
  void add_wedges(Built& built, const visibility::Light& light);

  const render::Device* on;
  Options options;
  std::optional<Device> gpu;
  std::optional<ShadowCasters> casters;
};

WedgeBuilder::WedgeBuilder(const render::Device& device, const Options& options)
    : state_(std::make_unique<State>(device, options)) {}
WedgeBuilder::~WedgeBuilder() = default;
WedgeBuilder::WedgeBuilder(WedgeBuilder&&) noexcept = default;
WedgeBuilder& WedgeBuilder::operator=(WedgeBuilder&&) noexcept = default;

void WedgeBuilder::prepare_mesh(const SceneFloats& scene) {
  State& s = *state_;
  s.casters.emplace(scene, s.options.layers);
  if (!s.gpu) return;
  s.gpu->holds_mesh = s.gpu->silhouettes.prepare_mesh({scene.positions, s.casters->triangles(), &s.casters->graph()});
}

WedgeBuilder::Built WedgeBuilder::build(const visibility::Light& light) {
  State& s = *state_;
  PENUMBRA_ASSERT(s.casters.has_value(), "build before prepare_mesh");
  const glm::vec3 l = center_of(light);
  const bool on_device = s.gpu && s.gpu->holds_mesh;
  Built built;
  if (on_device) {
    SilhouettePass& silhouettes = s.gpu->silhouettes;
    silhouettes.evaluate(l, s.casters->counted_sides(l, light));
    built.volumes = s.casters->assembled(l, silhouettes.read_sides(), silhouettes.read_edges());
    built.facings_on_host = silhouettes.open_facings();
  } else {
    built.volumes = s.casters->seen_from(l, light);
    built.facings_on_host = s.casters->size();
  }
  if (on_device && s.options.construction == Construction::original) {
    s.add_wedges(built, light);
  } else {
    built.wedges = wedges_of(built.volumes, light, s.options.construction);
    built.edges_on_host = built.volumes.edges.size();
  }
  return built;
}

void WedgeBuilder::State::add_wedges(Built& built, const visibility::Light& light) {
  const std::vector<VolumeEdge>& edges = built.volumes.edges;
  const LightHull hull = light_hull(light);
  const std::vector<gpu::BuiltWedge> proposed = build_on_device(hull);
  std::vector<std::uint32_t> missing;
  for (std::uint32_t i = 0; i < proposed.size(); ++i) {
    if (proposed[i].proved == 0) missing.push_back(i);
  }
  built.edges_on_host = missing.size();
  std::vector<Wedge> hosts = build_wedges(wedge_edges(edges, missing), hull, Construction::original);
  built.wedges = {edges, merged(edges, proposed, missing, std::move(hosts))};
}

/// Builds as many wedges at a time as a buffer holds.
std::vector<gpu::BuiltWedge> WedgeBuilder::State::build_on_device(const LightHull& hull) {
  Device& d = *gpu;
  std::vector<gpu::BuiltWedge> built(d.silhouettes.count());
  if (built.empty()) return built;
  const std::span<const glm::dvec3> corners(hull.corners);
  render::grow(*on, d.corners, "corners of the light", corners.size_bytes());
  d.corners->write(corners);
  gpu::WedgeBuildPush push{
      {hull.center.x, hull.center.y, hull.center.z}, 0, 0, static_cast<std::uint32_t>(corners.size()), 0};
  const std::uint64_t most_bytes = options.most_bytes != 0 ? options.most_bytes : on->limits().max_storage_buffer_range;
  const std::size_t most = most_bytes / sizeof(gpu::BuiltWedge);
  for (std::size_t first = 0; first < built.size(); first += most) {
    const std::span<gpu::BuiltWedge> batch = std::span(built).subspan(first, std::min(most, built.size() - first));
    render::grow(*on, d.wedges, "built wedges", batch.size_bytes());
    push.first = static_cast<std::uint32_t>(first);
    push.count = static_cast<std::uint32_t>(batch.size());
    d.build.record(
        d.commands, push,
        {d.silhouettes.silhouettes(), d.silhouettes.ends(), d.silhouettes.positions(), *d.corners, *d.wedges},
        (batch.size() + 63) / 64);
    d.times.add(d.commands.submit());
    d.wedges->read(batch);
  }
  return built;
}

std::vector<visibility::PassTime> WedgeBuilder::take_pass_times() {
  visibility::PassTimes all;
  if (state_->gpu) {
    all.add(state_->gpu->silhouettes.take_pass_times());
    all.add(state_->gpu->times.take());
  }
  return all.take();
}

std::uint64_t WedgeBuilder::memory_bytes() const {
  if (!state_->gpu) return 0;
  const State::Device& d = *state_->gpu;
  std::uint64_t bytes = d.silhouettes.memory_bytes();
  for (const auto* buffer : {&d.corners, &d.wedges}) {
    if (*buffer) bytes += (*buffer)->bytes();
  }
  return bytes;
}

}  // namespace penumbra::volumes
