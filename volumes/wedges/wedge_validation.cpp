// SPDX-License-Identifier: Apache-2.0
// Proves the invariants of wedges, of their split pieces and of silhouette loops (wedge_validation.hpp lists them). Not
// from a paper.

#include "volumes/wedges/wedge_validation.hpp"

#include "mesh/half_edge_view.hpp"
#include "mesh/predicates.hpp"
#include "volumes/wedges/wedge_proofs.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <utility>

namespace penumbra::volumes {
namespace {

ValidationReport joined(ValidationReport left, const ValidationReport& right) {
  left.violations.insert(left.violations.end(), right.violations.begin(), right.violations.end());
  for (std::size_t i = 0; i < kInvariants; ++i) left.checks[i] += right.checks[i];
  left.flat += right.flat;
  left.cropped_planes += right.cropped_planes;
  return left;
}

/// Checks the invariant `cover`. Roots are the requested edges, in order; a split wedge has two pieces that meet in a
/// point of the edge, exactly.
class Cover {
 public:
  Cover(const WedgesToValidate& input, ValidationReport& report)
      : input_(input), report_(report), pieces_(input.wedges.size()) {}

  void check() {
    std::uint32_t roots = 0;
    for (std::uint32_t i = 0; i < input_.wedges.size(); ++i) {
      const Wedge& wedge = input_.wedges[i];
      ++report_.checks[static_cast<std::size_t>(Invariant::cover)];
      if (wedge.parent) {
        if (*wedge.parent >= i) {
          fail(i, "a piece comes before the wedge that was split");
        } else {
          pieces_[*wedge.parent].push_back(i);
        }
        continue;
      }
      const std::uint32_t source = roots++;
      if (source >= input_.casting.wedges.size() || wedge.source != source) {
        fail(i, "this is not the next of the requested edges");
      } else if (wedge.a != input_.casting.wedges[source].a || wedge.b != input_.casting.wedges[source].b) {
        fail(i, "the ends are not those of the edge");
      }
    }
    if (roots != input_.casting.wedges.size()) {
      fail(std::nullopt, fmt::format("{} wedges for {} edges", roots, input_.casting.wedges.size()));
    }
    for (std::uint32_t i = 0; i < input_.wedges.size(); ++i) check_pieces(i);
  }

 private:
  void check_pieces(std::uint32_t i) {
    const Wedge& whole = input_.wedges[i];
    const std::vector<std::uint32_t>& pieces = pieces_[i];
    if ((whole.outcome == WedgeOutcome::split) != !pieces.empty())
      return fail(i, "pieces of a wedge that is not split, or a split wedge without pieces");
    if (pieces.empty()) return;
    if (pieces.size() != 2) return fail(i, fmt::format("{} pieces", pieces.size()));
    const Wedge &one = input_.wedges[pieces[0]], &two = input_.wedges[pieces[1]];
    const glm::dvec3& middle = one.b;
    const bool between = glm::all(glm::lessThanEqual(glm::min(whole.a, whole.b), middle)) &&
                         glm::all(glm::lessThanEqual(middle, glm::max(whole.a, whole.b)));
    if (one.a != whole.a || two.a != middle || two.b != whole.b || !between ||
        !mesh::collinear(whole.a, middle, whole.b)) {
      fail(i, "the pieces do not add up to the edge");
    }
  }

  void fail(std::optional<std::uint32_t> wedge, std::string what) {
    const glm::dvec3 point = wedge ? input_.wedges[*wedge].a : glm::dvec3(0);
    report_.violations.push_back({Invariant::cover, wedge, {}, point, 0, std::move(what)});
  }

  const WedgesToValidate& input_;
  ValidationReport& report_;
  std::vector<std::vector<std::uint32_t>> pieces_;
};

/// Returns each edge's signed multiplicity k_e, counted along the silhouette loops of the half-edge view. A loop that
/// is not connected is a violation. Faces that the view does not hold must be `on` in `sides`.
std::vector<int> carried_by_loops(const Casters& casters, const mesh::HalfEdgeView& surface,
                                  std::span<const mesh::Side> sides, ValidationReport& report) {
  std::vector<int> carried(casters.graph.edges.size(), 0);
  for (const mesh::Side side : {mesh::Side::front, mesh::Side::back}) {
    for (const mesh::SurfaceLoop& loop : surface.silhouette_loops(sides, side)) {
      for (std::size_t i = 0; i < loop.edges.size(); ++i) {
        const mesh::Edge& edge = casters.graph.edges[loop.edges[i]];
        const std::uint32_t from = surface.point_of_vertex()[loop.vertices[i]],
                            to = surface.point_of_vertex()[loop.vertices[(i + 1) % loop.vertices.size()]];
        ++report.checks[static_cast<std::size_t>(Invariant::closed_loops)];
        if (std::minmax(from, to) != std::minmax(edge.a, edge.b)) {
          report.violations.push_back({Invariant::closed_loops,
                                       {},
                                       {},
                                       casters.positions[from],
                                       0,
                                       fmt::format("a loop leaves edge {}", loop.edges[i])});
        }
        carried[loop.edges[i]] += (from == edge.a) == (side == mesh::Side::front) ? 1 : -1;
      }
    }
  }
  return carried;
}

}  // namespace

const char* name_of(Invariant invariant) {
  static constexpr std::array kNames = {"numbers",    "cover",       "outcome",      "conservative", "sampled",
                                        "polyhedron", "half-spaces", "closed-loops", "coverage"};
  static_assert(kNames.size() == kInvariants);
  return kNames[static_cast<std::size_t>(invariant)];
}

void check_closed_loops(const Casters& casters, const LightHull& light, ValidationReport& report) {
  std::vector<mesh::Side> sides = mesh::facings(casters.view(), casters.graph, light.center);
  std::vector<int> balance(casters.positions.size(), 0);
  for (std::uint32_t edge = 0; edge < casters.graph.edges.size(); ++edge) {
    const int multiplicity = mesh::signed_multiplicity(casters.graph, edge, sides);
    balance[casters.graph.edges[edge].a] -= multiplicity;
    balance[casters.graph.edges[edge].b] += multiplicity;
  }
  for (std::size_t vertex = 0; vertex < balance.size(); ++vertex) {
    ++report.checks[static_cast<std::size_t>(Invariant::closed_loops)];
    if (balance[vertex] == 0) continue;
    report.violations.push_back({Invariant::closed_loops,
                                 {},
                                 {},
                                 casters.positions[vertex],
                                 0,
                                 fmt::format("{} more silhouettes enter than leave", balance[vertex])});
  }
  const mesh::HalfEdgeView surface(casters.view(), casters.graph);
  const std::vector<int> carried = carried_by_loops(casters, surface, sides, report);
  for (const mesh::ListedFace& face : surface.listed()) sides[face.triangle] = mesh::Side::on;
  for (std::uint32_t edge = 0; edge < casters.graph.edges.size(); ++edge) {
    const int multiplicity = mesh::signed_multiplicity(casters.graph, edge, sides);
    if (multiplicity == carried[edge]) continue;
    report.violations.push_back(
        {Invariant::closed_loops,
         {},
         {},
         casters.positions[casters.graph.edges[edge].a],
         0,
         fmt::format("edge {}: loops have multiplicity {}, its triangles {}", edge, carried[edge], multiplicity)});
  }
}

ValidationReport validate(const WedgesToValidate& input) {
  ValidationReport report;
  Cover(input, report).check();
  const WedgeProofs proofs(input);
  report = joined(
      report,
      tbb::parallel_reduce(
          tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(input.wedges.size()), 8), ValidationReport{},
          [&](const tbb::blocked_range<std::uint32_t>& range, ValidationReport part) {
            for (std::uint32_t i = range.begin(); i != range.end(); ++i) proofs.check(i, part);
            return part;
          },
          [](const ValidationReport& left, const ValidationReport& right) { return joined(left, right); }));
  check_closed_loops(input.casters, input.light, report);
  return report;
}

}  // namespace penumbra::volumes
