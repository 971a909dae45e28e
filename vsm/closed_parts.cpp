#include "vsm/closed_parts.hpp"

#include "mesh/edge_graph.hpp"
#include "mesh/parallel.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <span>

namespace penumbra::vsm {
namespace {

using mesh::EdgeGraph;
using visibility::SceneFloats;

constexpr std::uint32_t kNone = 0xffffffffU;

/// The triangles that cast shadow and are no light's body, as a mesh of its own.
struct Casters {
  std::vector<glm::dvec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<std::uint32_t> in_scene;  ///< for each, its number in the scene
};

Casters casters_of(const SceneFloats& scene) {
  Casters casters{mesh::widened(scene.positions), {}, {}};
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.casts_shadow[t] == 0 || scene.emits[t] >= 0) continue;
    casters.triangles.push_back(scene.triangles[t]);
    casters.in_scene.push_back(t);
  }
  return casters;
}

/// Walks a component from `first`, winding each triangle as its neighbour. False if it is not closed, not manifold at
/// an edge, or not orientable.
bool wind_component(const EdgeGraph& graph, std::uint32_t first, std::vector<std::int8_t>& turn,
                    std::vector<std::uint32_t>& members) {
  bool closed = true;
  members.assign(1, first);
  turn[first] = 1;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::uint32_t t = members[i];
    for (const std::uint32_t edge : graph.triangle_edges[t]) {
      if (edge == EdgeGraph::kNoEdge) continue;
      const std::span<const mesh::Incidence> around = graph.around(edge);
      closed = closed && around.size() == 2;
      const auto own = std::ranges::find(around, t, &mesh::Incidence::triangle);
      for (const mesh::Incidence& other : around) {
        if (other.triangle == t) continue;
        const auto wanted = static_cast<std::int8_t>(own->reversed != other.reversed ? turn[t] : -turn[t]);
        if (turn[other.triangle] == 0) {
          turn[other.triangle] = wanted;
          members.push_back(other.triangle);
        }
        closed = closed && turn[other.triangle] == wanted;
      }
    }
  }
  return closed;
}

ClosedPart bounds_of(const SceneFloats& scene, std::span<const std::uint32_t> triangles) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr Box kEmpty{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
  const auto add = [](Box& box, const glm::vec3& at) { box = {glm::min(box.lower, at), glm::max(box.upper, at)}; };
  ClosedPart part{kEmpty, {kEmpty, kEmpty, kEmpty, kEmpty, kEmpty, kEmpty}};
  for (const std::uint32_t t : triangles) {
    for (const glm::vec3& corner : scene.corners(t)) add(part.box, corner);
  }
  for (const std::uint32_t t : triangles) {
    for (const glm::vec3& corner : scene.corners(t)) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto face = static_cast<std::size_t>(axis);
        if (corner[axis] == part.box.lower[axis]) add(part.touching[face], corner);
        if (corner[axis] == part.box.upper[axis]) add(part.touching[face + 3], corner);
      }
    }
  }
  return part;
}

/// Six times the volume that the triangles enclose, wound by `turn`: positive if their normals point outward. In
/// double: whichever way it comes out, shadows are right, and only speed depends on it.
double signed_volume(const SceneFloats& scene, std::span<const std::uint32_t> triangles,
                     const std::vector<std::int8_t>& turn) {
  double sum = 0;
  for (const std::uint32_t t : triangles) {
    const auto [a, b, c] = scene.corners(t);
    sum += turn[t] * glm::dot(glm::dvec3(a), glm::cross(glm::dvec3(b), glm::dvec3(c)));
  }
  return sum;
}

/// For each plane, the component that alone has triangles on it, or kNone.
std::vector<std::uint32_t> plane_owners(const SceneFloats& scene, const std::vector<std::uint32_t>& component) {
  constexpr std::uint32_t kUnseen = 0xfffffffeU;
  std::vector<std::uint32_t> owner(scene.triangles.size(), kUnseen);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.plane[t] == SceneFloats::kNoPlane) continue;
    std::uint32_t& of_plane = owner[scene.plane[t]];
    of_plane = of_plane == kUnseen || of_plane == component[t] ? component[t] : kNone;
  }
  return owner;
}

double size1(const glm::dvec3& x) {
  return glm::abs(x.x) + glm::abs(x.y) + glm::abs(x.z);
}

/// ±1: every light sample certainly sees the triangle from this side; 0: not certain. All arithmetic is in double on
/// float32 numbers; the margin of 2⁻²⁰ of every length that enters is a million times the rounding there, and covers
/// that light samples are stored in float32.
int side_shown(const std::array<glm::vec3, 3>& corners, const visibility::LightFrame& frame, float scale) {
  const glm::dvec3 a(corners[0] * scale), e1 = glm::dvec3(corners[1] * scale) - a,
                                          e2 = glm::dvec3(corners[2] * scale) - a;
  const glm::dvec3 normal = glm::cross(e1, e2), center(frame.center), u(frame.u), v(frame.v);
  const double at_center = glm::dot(normal, center - a);
  const double span = glm::abs(glm::dot(normal, u)) + glm::abs(glm::dot(normal, v));
  const double lengths = size1(center) + size1(u) + size1(v) + size1(a);
  const double margin = (0x1p-20 * lengths + static_cast<double>(frame.deviation)) * size1(e1) * size1(e2);
  if (at_center > span + margin) return 1;
  return at_center < -(span + margin) ? -1 : 0;
}

bool apart_from_light(const Box& box, const visibility::LightFrame& frame, float scale) {
  const glm::vec3 reach = glm::abs(frame.u) + glm::abs(frame.v);
  const glm::vec3 margin = 0x1p-20F * (glm::abs(frame.center) + reach) + frame.deviation;
  const glm::vec3 lower = frame.center - reach - margin, upper = frame.center + reach + margin;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.upper[axis] * scale < lower[axis] || box.lower[axis] * scale > upper[axis]) return true;
  }
  return false;
}

}  // namespace

ClosedParts find_closed_parts(const SceneFloats& scene) {
  const Casters casters = casters_of(scene);
  const EdgeGraph graph = mesh::build_edge_graph({casters.positions, casters.triangles});
  struct Candidate {
    std::uint32_t component;
    std::vector<std::uint32_t> triangles;  // of the scene
  };
  std::vector<Candidate> candidates;
  std::vector<std::int8_t> turn(casters.triangles.size());
  std::vector<std::uint32_t> component(scene.triangles.size(), kNone), members;
  std::uint32_t components = 0;
  for (std::uint32_t first = 0; first < casters.triangles.size(); ++first) {
    if (turn[first] != 0) continue;
    const bool closed = wind_component(graph, first, turn, members);
    for (std::uint32_t& t : members) component[t = casters.in_scene[t]] = components;
    if (closed && members.size() >= ClosedParts::kFewestTriangles) candidates.push_back({components, members});
    ++components;
  }
  const std::vector<std::uint32_t> owner = plane_owners(scene, component);
  std::erase_if(candidates, [&](const Candidate& c) {
    return std::ranges::any_of(c.triangles, [&](std::uint32_t t) { return owner[scene.plane[t]] != c.component; });
  });
  std::ranges::stable_sort(candidates, std::ranges::greater(), [](const Candidate& c) { return c.triangles.size(); });
  if (candidates.size() > ClosedParts::kMost) candidates.resize(ClosedParts::kMost);

  ClosedParts closed;
  if (candidates.empty()) return closed;
  closed.part.resize(scene.triangles.size());
  closed.turn.resize(scene.triangles.size());
  for (std::size_t i = 0; i < casters.in_scene.size(); ++i) closed.turn[casters.in_scene[i]] = turn[i];
  for (const Candidate& candidate : candidates) {
    closed.parts.push_back(bounds_of(scene, candidate.triangles));
    const bool outward = signed_volume(scene, candidate.triangles, closed.turn) > 0;
    for (const std::uint32_t t : candidate.triangles) {
      closed.part[t] = static_cast<std::uint8_t>(closed.parts.size());
      if (outward) closed.turn[t] = static_cast<std::int8_t>(-closed.turn[t]);
    }
  }
  return closed;
}

std::uint32_t parts_apart_from(const ClosedParts& closed, const visibility::LightFrame& frame, float scale) {
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < closed.parts.size(); ++i) {
    if (apart_from_light(closed.parts[i].box, frame, scale)) apart |= 1U << (i + 1);
  }
  return apart;
}

std::vector<std::uint8_t> find_dispensable(const ClosedParts& closed, const SceneFloats& scene,
                                           const visibility::LightFrame& frame, float scale) {
  std::vector<std::uint8_t> dispensable(scene.triangles.size());
  mesh::for_each_index(closed.part.size(), [&](std::size_t t) {
    if (closed.part[t] == 0) return;
    const int side = side_shown(scene.corners(static_cast<std::uint32_t>(t)), frame, scale);
    if (closed.turn[t] * side > 0) dispensable[t] = closed.part[t];
  });
  return dispensable;
}

}  // namespace penumbra::vsm
