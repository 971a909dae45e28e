#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

/// One layer a solid. Methods that add what triangles hide, and do not unite it, would take a closed surface twice: a
/// segment that enters it leaves it again. So of a *closed part* only the triangles count by which segments toward the
/// light leave for the region that holds the light's centre. Seen from a point outside, that is each solid once; seen
/// from one inside (a view sample that rounding put below its own surface), still once. Open surfaces count whole.
///
/// A closed part: triangles connected through edges, exactly two at every edge, that can be wound alike. A soup with a
/// hole, a fin or a T-junction is open, and a segment through both its sides counts two.
namespace penumbra::visibility {

/// The closed parts of a mesh. Found once: lights may move.
class ClosedCasters {
 public:
  ClosedCasters() = default;
  ClosedCasters(const mesh::MeshView& mesh, const mesh::EdgeGraph& graph);

  /// For each triangle of a closed part, the side (as mesh::Side, of the triangle as stored) on which the light's
  /// centre's region lies: outside of the part, or, if it is around c, inside. `on` for open ones. `light` reads ties.
  /// Exact except for which side is outside: the sign of the enclosed volume, in double. `mesh` is the constructor's.
  [[nodiscard]] std::vector<mesh::Side> light_sides(const mesh::MeshView& mesh, const Light& light,
                                                    const glm::vec3& c) const;

 private:
  struct Part {
    std::vector<std::uint32_t> triangles;
    int outside = 1;  // the side, once the triangles are wound by turn_
    glm::dvec3 lower{0}, upper{0};
  };
  [[nodiscard]] bool is_around(const Part& part, const mesh::MeshView& mesh, const Light& light,
                               const glm::vec3& c) const;

  std::vector<Part> parts_;
  std::vector<std::int8_t> turn_;  // ±1 for each triangle: as stored, or the other way round
};

/// ClosedCasters(mesh, graph).light_sides, where only one light is asked for.
std::vector<mesh::Side> light_sides(const mesh::MeshView& mesh, const mesh::EdgeGraph& graph, const Light& light,
                                    const glm::vec3& c);

/// Turns `on` the facings of what does not count, given mesh::facings from the light's centre, or from a view sample.
void keep_one_layer(std::span<const mesh::Side> light_sides, bool from_light, std::span<mesh::Side> facings);

}  // namespace penumbra::visibility
