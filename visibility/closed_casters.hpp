// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/predicates.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

/// Counts one layer of each solid. Methods that add hidden areas, instead of uniting them, would count a closed surface
/// twice: a segment that enters it leaves it again. So the only triangles of a *closed part* that count are those
/// through which segments toward the light pass into the region that contains the light's centre. Seen from a point
/// outside, each solid counts once; seen from inside (a view sample that rounding put below its own surface), also
/// once. Open surfaces count completely.
///
/// A closed part consists of triangles connected through edges, exactly two at every edge, that can be wound
/// consistently. A soup with a hole, a fin or a T-junction is open, and a segment through both its sides is counted
/// twice.
namespace penumbra::visibility {

/// The closed parts of a mesh. They are found once and stay valid when lights move.
class ClosedCasters {
 public:
  ClosedCasters() = default;
  ClosedCasters(const mesh::MeshView& mesh, const mesh::EdgeGraph& graph);

  /// Returns for each triangle of a closed part the side (as mesh::Side, of the triangle as stored) on which the region
  /// of the light's centre c lies: the outside of the part, or its inside if the part is around c. Returns `on` for
  /// triangles of open parts. `light` resolves ties. Exact, except that the outside is found by the sign of the
  /// enclosed volume, in double. `mesh` must be the one given to the constructor.
  [[nodiscard]] std::vector<mesh::Side> light_sides(const mesh::MeshView& mesh, const Light& light,
                                                    const glm::vec3& c) const;

 private:
  struct Part {
    std::vector<std::uint32_t> triangles;
    int outside = 1;  // side of the triangles, as wound by turn_, that is the part's outside
    glm::dvec3 lower{0}, upper{0};
  };
  [[nodiscard]] bool is_around(const Part& part, const mesh::MeshView& mesh, const Light& light,
                               const glm::vec3& c) const;

  std::vector<Part> parts_;
  std::vector<std::int8_t> turn_;  // for each triangle 1 (winding as stored) or −1 (reversed)
};

/// Returns ClosedCasters(mesh, graph).light_sides, for a single light.
std::vector<mesh::Side> light_sides(const mesh::MeshView& mesh, const mesh::EdgeGraph& graph, const Light& light,
                                    const glm::vec3& c);

/// Sets the facings of triangles that do not count to `on`; `facings` is mesh::facings from the light's centre
/// (`from_light`), or from a view sample.
void keep_one_layer(std::span<const mesh::Side> light_sides, bool from_light, std::span<mesh::Side> facings);

}  // namespace penumbra::visibility
