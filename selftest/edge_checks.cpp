// SPDX-License-Identifier: Apache-2.0
// Compares silhouettes, facings, volumes and wedges of the device with the host's.

#include "selftest/edge_checks.hpp"

#include "mesh/predicates.hpp"
#include "mesh/silhouettes.hpp"
#include "volumes/edges/device/facing.shared.h"
#include "volumes/wedges/wedge_plane.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace penumbra::selftest {
namespace {

std::string text_of(const glm::vec3& v) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z);
}

void compare_volumes(const volumes::LightVolumes& found, const volumes::LightVolumes& expected, Check& check) {
  const auto what = [](const char* text, std::size_t i) { return [=] { return fmt::format("{} {}", text, i); }; };
  check.same(found.edges.size(), expected.edges.size(), what("number of edges, not", expected.edges.size()));
  for (std::size_t i = 0; i < std::min(found.edges.size(), expected.edges.size()); ++i) {
    const auto &a = found.edges[i], &b = expected.edges[i];
    check.same(a.a == b.a && a.b == b.b && a.multiplicity == b.multiplicity, true, what("edge", i));
  }
  check.same(found.caps.size(), expected.caps.size(), what("number of caps, not", expected.caps.size()));
  for (std::size_t i = 0; i < std::min(found.caps.size(), expected.caps.size()); ++i) {
    const auto &a = found.caps[i], &b = expected.caps[i];
    check.same(a.corners == b.corners && a.plane == b.plane, true, what("cap", i));
  }
  check.same(found.left_out, expected.left_out, [] { return "which triangles are left out"; });
}

/// Returns the sine of the angle between normals; more than 3 if they point to opposite sides.
double angle(const volumes::Plane& a, const volumes::Plane& b) {
  const glm::dvec3 n = glm::normalize(a.normal()), m = glm::normalize(b.normal());
  return glm::length(glm::cross(n, m)) + (glm::dot(n, m) < 0 ? 4 : 0);
}

/// Compares the planes with the host's construction: bounding the penumbra alone is not sufficient.
void compare_wedges(const volumes::LightWedges& found, const volumes::LightWedges& expected, Check& check) {
  constexpr double kAngle = 1e-6;  // planes are rounded outward in steps of floats
  const auto place = [](std::size_t i) { return [=] { return fmt::format("wedge {}", i); }; };
  check.same(found.wedges.size(), expected.wedges.size(), place(expected.wedges.size()));
  for (std::size_t i = 0; i < std::min(found.wedges.size(), expected.wedges.size()); ++i) {
    const volumes::Wedge &d = found.wedges[i], &h = expected.wedges[i];
    check.same(d.source == h.source && d.parent == h.parent && d.outcome == h.outcome && d.a == h.a && d.b == h.b &&
                   d.planes.size() == h.planes.size(),
               true, place(i));
    for (std::size_t k = 0; k < std::min(d.planes.size(), h.planes.size()); ++k) {
      check.within(angle(d.planes[k], h.planes[k]), kAngle, place(i));
    }
  }
}

}  // namespace

EdgeMesh::EdgeMesh(const mesh::TriangleSoup& soup, double scale) : triangles(soup.triangles) {
  for (const glm::dvec3& p : soup.positions) positions.emplace_back(p * scale);
  wide = mesh::widened(positions);
  graph = mesh::build_edge_graph(view());
}

Check check_silhouettes(volumes::SilhouettePass& pass, const EdgeMesh& mesh, const glm::vec3& l,
                        const std::vector<std::uint32_t>& counted, SilhouetteTally& tally) {
  Check check{.pass = "silhouettes", .against = "exact signs", .rule = "the same sides, edges and multiplicities"};
  std::vector<mesh::Side> sides = mesh::facings(mesh.view(), mesh.graph, l);
  pass.evaluate(l, counted);
  const std::vector<std::uint32_t> found = pass.read_sides();
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::uint32_t side = volumes::bits_of(sides[i]);
    check.same(found[i], side | (side & counted[i]) << volumes::gpu::kCountedShift,
               [&] { return fmt::format("triangle {} from {}", i, text_of(l)); });
    tally.ties += sides[i] == mesh::Side::on ? 1 : 0;
    if ((side & counted[i]) == 0) sides[i] = mesh::Side::on;
  }
  std::vector<mesh::SilhouetteEdge> expected;
  for (std::uint32_t edge = 0; edge < mesh.graph.edges.size(); ++edge) {
    const int k = mesh::signed_multiplicity(mesh.graph, edge, sides);
    if (k != 0) expected.push_back({edge, k});
  }
  const std::vector<mesh::SilhouetteEdge> edges = pass.read_edges();
  const auto from = [&] { return fmt::format("{} edges, not {}, from {}", edges.size(), expected.size(), text_of(l)); };
  check.same(edges.size(), expected.size(), from);
  check.same<std::uint64_t>(pass.count(), expected.size(), from);
  for (std::size_t i = 0; i < std::min(edges.size(), expected.size()); ++i) {
    check.same(edges[i] == expected[i], true, [&] { return fmt::format("silhouette edge {} from {}", i, text_of(l)); });
  }
  ++tally.points;
  tally.silhouettes += expected.size();
  tally.open += pass.open_facings();
  return check;
}

Check check_wedges(const render::Device& device, const visibility::SceneFloats& floats,
                   std::span<const visibility::Light> lights, volumes::Layers layers, bool like_host,
                   WedgeTally& tally) {
  using namespace volumes;
  Check check{.pass = "penumbra wedges",
              .against = "the host's, and exact signs",
              .rule = "the same volumes; planes bound the penumbra, and equal the host's within the angle"};
  WedgeBuilder on_device(device, {WedgesOn::device, Construction::original, layers});
  WedgeBuilder on_host(device, {WedgesOn::host, Construction::original, layers});
  on_device.prepare_mesh(floats);
  on_host.prepare_mesh(floats);
  for (const visibility::Light& light : lights) {
    const WedgeBuilder::Built built = on_device.build(light), expected = on_host.build(light);
    compare_volumes(built.volumes, expected.volumes, check);
    check.same<std::uint64_t>(expected.edges_on_host, expected.wedges.edges.size(),
                              [] { return "the host's own edges"; });
    check.same(built.wedges.edges.size(), built.volumes.edges.size(), [] { return "one wedge for each edge"; });
    tally.on_host += built.edges_on_host;
    tally.edges += expected.edges_on_host;
    const LightHull hull = light_hull(light);
    for (const Wedge& wedge : built.wedges.wedges) {
      for (const Plane& plane : wedge.planes) {
        ++tally.planes;
        check.same(bounds_penumbra(plane, {wedge.a, wedge.b, hull.corners}), true, [&] {
          return fmt::format("light {}: a plane of the wedge of edge {} cuts its penumbra", light.index, wedge.source);
        });
      }
    }
    if (like_host) compare_wedges(built.wedges, expected.wedges, check);
  }
  return check;
}

}  // namespace penumbra::selftest
