// SPDX-License-Identifier: Apache-2.0
// Builds a half-edge structure (OpenMesh) from the selected triangles, and walks its silhouette loops.

#include "mesh/half_edge_view.hpp"

#include "base/assert.hpp"
#include "mesh/half_edge_choice.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>

namespace penumbra::mesh {
namespace {

/// Stores connectivity only: positions stay in the soup, and nothing is ever deleted.
struct Traits : OpenMesh::DefaultTraits {
  VertexAttributes(OpenMesh::Attributes::None);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
  FaceAttributes(OpenMesh::Attributes::None);
};
using OpenMeshSurface = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using HalfedgeHandle = OpenMesh::HalfedgeHandle;
using VertexHandle = OpenMesh::VertexHandle;
using FaceHandle = OpenMesh::FaceHandle;

/// Converts OpenMesh's handles, which are int.
std::uint32_t number(const OpenMesh::BaseHandle& handle) {
  return handle.is_valid() ? static_cast<std::uint32_t>(handle.idx()) : HalfEdgeView::kNone;
}
template <typename Handle>
Handle handle(std::uint32_t number) {
  return Handle(static_cast<int>(number));
}

/// Silences the stream on which OpenMesh explains, to stderr, why it refuses a face; `listed` has the reasons here.
void silence_openmesh() {
  omerr().disable();
}

}  // namespace

struct HalfEdgeView::Surface {
  OpenMeshSurface mesh;
  std::vector<std::uint32_t> triangle_of_face, face_of_triangle, point_of_vertex, component_of_face, turned;
  std::vector<std::uint32_t> edge_of_halfedge_pair;  // for each edge of OpenMesh, the edge of the edge graph
  std::vector<ListedFace> listed;
  std::vector<SurfaceComponent> components;

  void add_faces(const MeshView& soup, const EdgeGraph& graph);
  void name_edges(const MeshView& soup, const EdgeGraph& graph);
  void find_components();
  void check(const MeshView& soup) const;

  [[nodiscard]] std::uint32_t face_left_of(HalfedgeHandle h) const { return number(mesh.face_handle(h)); }
  [[nodiscard]] bool is_rim(HalfedgeHandle h, const std::vector<bool>& inside) const {
    const std::uint32_t left = face_left_of(h), right = face_left_of(mesh.opposite_halfedge_handle(h));
    return left != kNone && inside[left] && (right == kNone || !inside[right]);
  }
  [[nodiscard]] HalfedgeHandle next_on_rim(HalfedgeHandle h, const std::vector<bool>& inside) const;
};

void HalfEdgeView::Surface::add_faces(const MeshView& soup, const EdgeGraph& graph) {
  const HeldTriangles held = choose_held(graph);
  HeldFans fans = find_held_fans(soup, graph, held);
  listed = held.listed;
  face_of_triangle.assign(soup.triangles.size(), kNone);
  const std::size_t face_count = soup.triangles.size() - listed.size();
  mesh.reserve(fans.point.size(), 3 * face_count / 2, face_count);
  for (std::size_t i = 0; i < fans.point.size(); ++i) mesh.new_vertex();
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    if (held.patch[t] == HeldTriangles::kNotHeld) continue;
    const auto corner = [&](std::uint32_t i) { return handle<VertexHandle>(fans.of_corner[3 * t + i]); };
    const FaceHandle face =
        held.turn[t] ? mesh.add_face(corner(0), corner(2), corner(1)) : mesh.add_face(corner(0), corner(1), corner(2));
    if (!face.is_valid()) {
      listed.push_back({t, NotHeld::refused});
      continue;
    }
    PENUMBRA_ASSERT(number(face) == triangle_of_face.size(), "face {} of {}", number(face), triangle_of_face.size());
    face_of_triangle[t] = number(face);
    triangle_of_face.push_back(t);
    if (held.turn[t]) turned.push_back(t);
  }
  std::ranges::sort(listed, {}, &ListedFace::triangle);
  point_of_vertex = std::move(fans.point);
}

void HalfEdgeView::Surface::name_edges(const MeshView& soup, const EdgeGraph& graph) {
  edge_of_halfedge_pair.assign(mesh.n_edges(), kNone);
  for (std::uint32_t face = 0; face < triangle_of_face.size(); ++face) {
    const std::uint32_t t = triangle_of_face[face];
    const Triangle corners = graph.corners(soup.triangles[t]);
    for (const HalfedgeHandle h : mesh.fh_range(handle<FaceHandle>(face))) {
      const std::uint32_t a = point_of_vertex[number(mesh.from_vertex_handle(h))];
      const std::uint32_t b = point_of_vertex[number(mesh.to_vertex_handle(h))];
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::minmax(corners[i], corners[(i + 1) % 3]) != std::minmax(a, b)) continue;
        edge_of_halfedge_pair[number(mesh.edge_handle(h))] = graph.triangle_edges[t][i];
      }
    }
  }
}

void HalfEdgeView::Surface::find_components() {
  component_of_face.assign(triangle_of_face.size(), kNone);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t seed = 0; seed < component_of_face.size(); ++seed) {
    if (component_of_face[seed] != kNone) continue;
    const auto component = static_cast<std::uint32_t>(components.size());
    SurfaceComponent& surface = components.emplace_back(SurfaceComponent{0, seed, true});
    component_of_face[seed] = component;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::uint32_t face = stack.back();
      stack.pop_back();
      ++surface.faces;
      for (const HalfedgeHandle h : mesh.fh_range(handle<FaceHandle>(face))) {
        const std::uint32_t other = face_left_of(mesh.opposite_halfedge_handle(h));
        if (other == kNone) surface.closed = false;
        if (other == kNone || component_of_face[other] != kNone) continue;
        component_of_face[other] = component;
        stack.push_back(other);
      }
    }
  }
}

void HalfEdgeView::Surface::check(const MeshView& soup) const {
  PENUMBRA_ASSERT(triangle_of_face.size() + listed.size() == soup.triangles.size(), "{} held + {} listed of {}",
                  triangle_of_face.size(), listed.size(), soup.triangles.size());
  for (const ListedFace& face : listed) {
    PENUMBRA_ASSERT(face_of_triangle[face.triangle] == kNone, "triangle {} is held and listed", face.triangle);
  }
}

/// Returns the next edge of the loop: turns at h's end through the faces inside until one is missing. The walk never
/// returns to h, whose right side is outside, so each rim edge has one successor and one predecessor: every loop
/// closes.
HalfedgeHandle HalfEdgeView::Surface::next_on_rim(HalfedgeHandle h, const std::vector<bool>& inside) const {
  HalfedgeHandle next = mesh.next_halfedge_handle(h);
  while (!is_rim(next, inside)) next = mesh.next_halfedge_handle(mesh.opposite_halfedge_handle(next));
  return next;
}

HalfEdgeView::HalfEdgeView(const MeshView& mesh, const EdgeGraph& graph) : surface_(std::make_unique<Surface>()) {
  silence_openmesh();
  surface_->add_faces(mesh, graph);
  surface_->name_edges(mesh, graph);
  surface_->find_components();
  surface_->check(mesh);
}

HalfEdgeView::HalfEdgeView(HalfEdgeView&&) noexcept = default;
HalfEdgeView& HalfEdgeView::operator=(HalfEdgeView&&) noexcept = default;
HalfEdgeView::~HalfEdgeView() = default;

std::span<const std::uint32_t> HalfEdgeView::triangle_of_face() const {
  return surface_->triangle_of_face;
}
std::span<const std::uint32_t> HalfEdgeView::face_of_triangle() const {
  return surface_->face_of_triangle;
}
std::span<const std::uint32_t> HalfEdgeView::point_of_vertex() const {
  return surface_->point_of_vertex;
}
std::span<const ListedFace> HalfEdgeView::listed() const {
  return surface_->listed;
}
std::span<const std::uint32_t> HalfEdgeView::turned() const {
  return surface_->turned;
}
std::span<const SurfaceComponent> HalfEdgeView::components() const {
  return surface_->components;
}
std::span<const std::uint32_t> HalfEdgeView::component_of_face() const {
  return surface_->component_of_face;
}

Triangle HalfEdgeView::corners(std::uint32_t face) const {
  const auto& mesh = surface_->mesh;
  const HalfedgeHandle h = mesh.halfedge_handle(handle<FaceHandle>(face));
  return {number(mesh.from_vertex_handle(h)), number(mesh.to_vertex_handle(h)),
          number(mesh.to_vertex_handle(mesh.next_halfedge_handle(h)))};
}

std::vector<SurfaceLoop> HalfEdgeView::loops_around(const std::vector<bool>& inside) const {
  const auto& mesh = surface_->mesh;
  PENUMBRA_ASSERT(inside.size() == mesh.n_faces(), "{} flags for {} faces", inside.size(), mesh.n_faces());
  std::vector<bool> walked(mesh.n_halfedges(), false);
  std::vector<SurfaceLoop> loops;
  for (std::uint32_t i = 0; i < mesh.n_halfedges(); ++i) {
    const auto start = handle<HalfedgeHandle>(i);
    if (walked[i] || !surface_->is_rim(start, inside)) continue;
    SurfaceLoop& loop = loops.emplace_back();
    loop.component = surface_->component_of_face[surface_->face_left_of(start)];
    HalfedgeHandle h = start;
    do {
      PENUMBRA_ASSERT(!walked[number(h)], "a loop does not close: half-edge {}", number(h));
      walked[number(h)] = true;
      loop.vertices.push_back(number(mesh.from_vertex_handle(h)));
      loop.edges.push_back(surface_->edge_of_halfedge_pair[number(mesh.edge_handle(h))]);
      h = surface_->next_on_rim(h, inside);
    } while (h != start);
  }
  return loops;
}

std::vector<SurfaceLoop> HalfEdgeView::silhouette_loops(std::span<const Side> facings, Side side) const {
  PENUMBRA_ASSERT(side != Side::on, "loops are around the front or the back");
  std::vector<bool> inside(surface_->mesh.n_faces());
  for (std::uint32_t face = 0; face < inside.size(); ++face) {
    inside[face] = facings[surface_->triangle_of_face[face]] == side;
  }
  for (const std::uint32_t t : surface_->turned) {
    inside[surface_->face_of_triangle[t]] = facings[t] == opposite(side);
  }
  return loops_around(inside);
}

}  // namespace penumbra::mesh
