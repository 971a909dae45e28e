// SPDX-License-Identifier: Apache-2.0
// Times the parts that run on the processor once for each mesh: edge graph, edge records, hierarchy, wedges.

#include "bench/cpu.hpp"

#include "mesh/edge_graph.hpp"
#include "session/process/stopwatch.hpp"
#include "session/session.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/tree_texels.hpp"
#include "volumes/edges/edge_set.hpp"
#include "volumes/edges/edge_tree.hpp"
#include "volumes/wedges/penumbra_wedge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace penumbra::bench {
namespace {

constexpr std::array kParts = {"edge-graph", "edge-records", "edge-hierarchy"};

/// Returns the seconds of the timed runs of `work`, after one discarded run.
template <typename Work>
std::vector<double> time_runs(std::uint32_t runs, const Work& work) {
  work();
  std::vector<double> seconds;
  for (std::uint32_t run = 0; run < runs; ++run) {
    const session::Stopwatch watch;
    work();
    seconds.push_back(watch.seconds());
  }
  return seconds;
}

/// Measures the three parts on one knot, in the order of kParts.
std::vector<CpuEntry> measure_edges(std::uint64_t triangles, std::uint32_t runs) {
  const visibility::SceneFloats floats = visibility::make_scene_floats(knot_scene(triangles));
  const auto positions = mesh::widened(floats.positions);
  CpuEntry entry;
  entry.triangles = floats.triangles.size();
  std::vector<CpuEntry> entries;
  const auto add = [&](std::vector<double> seconds, std::uint64_t items) {
    entry.name = fmt::format("cpu/{}/triangles={}", kParts[entries.size()], triangles);
    entry.seconds = std::move(seconds);
    entry.items = items;
    entries.push_back(entry);
    entry.load_before = load_of_machine();
  };
  entry.load_before = load_of_machine();
  mesh::EdgeGraph graph;
  const auto graph_seconds = time_runs(runs, [&] { graph = mesh::build_edge_graph({positions, floats.triangles}); });
  entry.edges = graph.edges.size();
  add(graph_seconds, graph.edges.size());
  std::vector<volumes::EdgeRecord> records;
  add(time_runs(runs, [&] { records = volumes::edge_records(floats, volumes::edge_casters(floats, -1)); }), 0);
  entries.back().items = records.size();
  volumes::EdgeTexels texels;
  const float scale = visibility::device_scale(floats);
  add(time_runs(runs, [&] { texels = volumes::edge_texels(records, scale); }), records.size());
  entries.back().counts = {{"depth", texels.depth}};
  return entries;
}

/// Returns a knot with at least `edges` edges; a knot has 3 · segments · sides of them.
mesh::TriangleSoup knot_with_edges(std::uint64_t edges) {
  const double sides = std::max(3.0, std::floor(std::sqrt(static_cast<double>(edges) / 12)));
  mesh::KnotShape knot;
  knot.center = {0, 1, 0};
  knot.radius = 0.8;
  knot.sides = static_cast<std::uint32_t>(sides);
  knot.segments = static_cast<std::uint32_t>(std::max(3.0, std::ceil(static_cast<double>(edges) / (3 * sides))));
  return mesh::make_knot(knot);
}

/// Returns the square light of the knot's scene.
volumes::LightHull square_light() {
  volumes::LightHull light;
  light.center = {0.5, 5, 0.5};
  for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    light.corners.push_back(light.center + glm::dvec3(u, 0, v));
  }
  return light;
}

void measure_wedges(const Options& options, const std::function<void(const CpuEntry&)>& sink) {
  const mesh::TriangleSoup soup = knot_with_edges(options.edges);
  const mesh::EdgeGraph graph = mesh::build_edge_graph({soup.positions, soup.triangles});
  std::vector<volumes::WedgeEdge> edges;
  for (const mesh::Edge& edge : std::span(graph.edges).first(options.edges)) {
    edges.push_back({soup.positions[edge.a], soup.positions[edge.b], {}});
  }
  const volumes::LightHull light = square_light();
  for (const auto& [construction, name] :
       {std::pair{volumes::Construction::original, "original"}, {volumes::Construction::tight, "tight"}}) {
    CpuEntry entry;
    entry.name = fmt::format("cpu/wedges/{}/edges={}", name, options.edges);
    entry.triangles = soup.triangles.size();
    entry.edges = entry.items = edges.size();
    entry.load_before = load_of_machine();
    std::vector<volumes::Wedge> wedges;
    const auto build = [&, how = construction] { wedges = volumes::build_wedges(edges, light, how); };
    entry.seconds = time_runs(options.runs, build);
    for (const volumes::Wedge& wedge : wedges) ++entry.counts[volumes::name_of(wedge.outcome)];
    sink(entry);
  }
}

}  // namespace

double load_of_machine() {
  double load = 0;
  return ::getloadavg(&load, 1) == 1 ? load : std::numeric_limits<double>::quiet_NaN();
}

void measure_cpu(const Options& options, const std::function<void(const CpuEntry&)>& sink) {
  std::vector<double> before;
  for (const std::uint64_t triangles : options.triangles) {
    std::vector<double> medians;
    for (CpuEntry& entry : measure_edges(triangles, options.runs)) {
      medians.push_back(session::median(entry.seconds));
      if (!before.empty()) entry.growth = medians.back() / before[medians.size() - 1];
      sink(entry);
    }
    before = std::move(medians);
  }
  measure_wedges(options, sink);
}

}  // namespace penumbra::bench
