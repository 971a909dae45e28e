// SPDX-License-Identifier: Apache-2.0
// Tests the generator of broken meshes against the diagnosis: a mesh has exactly the defects that were put into it. The
// expected counts are formulas; the diagnosis searches.

#include "base/error.hpp"
#include "mesh/shapes/broken_meshes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

namespace penumbra::mesh {
namespace {

/// The counts with their names, so that a difference can be read.
using Counts = std::vector<std::pair<const char*, std::uint64_t>>;

Counts counts(const KnownDiagnosis& known) {
  return {{"triangles", known.triangles},
          {"vertices", known.vertices},
          {"components", known.components},
          {"closed", known.closed},
          {"closed as wound", known.closed_as_wound},
          {"boundary edges", known.boundary_edges},
          {"boundary loops", known.boundary_loops},
          {"non-manifold edges", known.non_manifold_edges},
          {"non-manifold vertices", known.non_manifold_vertices},
          {"inconsistent windings", known.inconsistent_windings},
          {"duplicate faces", known.duplicate_faces},
          {"opposite faces", known.opposite_faces},
          {"zero-area triangles", known.zero_area_triangles},
          {"needles", known.needles},
          {"T-junctions", known.t_junctions},
          {"self-intersections", known.self_intersections}};
}

KnownDiagnosis found_in(const TriangleSoup& soup, bool search_intersections = true) {
  DiagnosisOptions options;
  options.search_intersections = search_intersections;
  const Diagnosis found = diagnose({soup.positions, soup.triangles}, options);
  KnownDiagnosis result{.triangles = found.triangles, .vertices = found.vertices, .components = found.components};
  result.closed = found.closed;
  result.closed_as_wound = found.closed_as_wound;
  result.boundary_edges = found.boundary_edges.count;
  result.boundary_loops = found.boundary_loops;
  result.non_manifold_edges = found.non_manifold_edges.count;
  result.non_manifold_vertices = found.non_manifold_vertices.count;
  result.inconsistent_windings = found.inconsistent_windings.count;
  result.duplicate_faces = found.duplicate_faces.count;
  result.opposite_faces = found.opposite_faces.count;
  result.zero_area_triangles = found.zero_area_triangles.count;
  result.needles = found.needles.count;
  result.t_junctions = found.t_junctions.count;
  result.self_intersections = found.self_intersections ? found.self_intersections->count : 0;
  return result;
}

testing::AssertionResult has_what_it_was_made_to_have(const BrokenShape& shape) {
  const BrokenMesh mesh = make_broken_mesh(shape);
  const Counts known = counts(mesh.known), found = counts(found_in(mesh.soup));
  std::string differences;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] == found[i]) continue;
    differences += fmt::format("; {}: {} known, {} found", known[i].first, known[i].second, found[i].second);
  }
  if (differences.empty()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << fmt::format("{} at size {}", fmt::join(shape.defects, " + "), shape.size)
                                     << differences;
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const DefectName& defect : broken_defects()) result.emplace_back(defect.name);
  return result;
}

TEST(BrokenMeshes, EachDefectIsFoundAlone) {
  for (const std::string& name : names()) {
    for (const std::uint32_t size : {1u, 2u, 3u, 4u, 7u}) EXPECT_TRUE(has_what_it_was_made_to_have({{name}, size}));
  }
}

TEST(BrokenMeshes, EveryPairOfDefectsIsFound) {
  const std::vector<std::string> all = names();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); ++j) {
      for (std::uint32_t size = 1; size <= 3; ++size) {
        EXPECT_TRUE(has_what_it_was_made_to_have({{all[i], all[j]}, size, {1, -3, 0.5}, 2}));
      }
    }
  }
}

TEST(BrokenMeshes, AllTogether) {
  EXPECT_TRUE(has_what_it_was_made_to_have({names(), 4, {0, 0, 0}, 8}));
}

TEST(BrokenMeshes, LargeOnesFull) {
  for (const std::string& name : names()) EXPECT_TRUE(has_what_it_was_made_to_have({{name}, 64}));
  EXPECT_TRUE(has_what_it_was_made_to_have({names(), 64}));
}

/// The lattice is exact at any place and for any size, also for unusual ones.
TEST(BrokenMeshes, AnywhereAtAnyScale) {
  for (const double half_extent : {0.1, 1.7, 3e-5, 1e6}) {
    for (const glm::dvec3& center : {glm::dvec3(0.1, 0.7, -0.3), glm::dvec3(1000.0 / 3, -77.7, 1e-3)}) {
      const glm::dvec3 scaled = center * half_extent;
      const BrokenShape shape{names(), 2, scaled, half_extent};
      EXPECT_TRUE(has_what_it_was_made_to_have(shape)) << "half extent " << half_extent << " at " << scaled.x;
      glm::dvec3 low(1e300), high(-1e300);
      for (const glm::dvec3& p : make_broken_mesh(shape).soup.positions)
        low = glm::min(low, p), high = glm::max(high, p);
      const glm::dvec3 half = (high - low) / 2.0, middle = (high + low) / 2.0;
      const double longest = std::max({half.x, half.y, half.z});
      EXPECT_LE(longest, half_extent);
      EXPECT_GT(longest, half_extent / 2);
      // The centre is off by half a lattice step along each axis; seven parts in a row are more than 2^14 steps wide.
      EXPECT_LE(glm::length(middle - scaled), std::sqrt(3.0) / 2 * std::ldexp(2 * half_extent, -14));
    }
  }
}

/// A test of this test: a mesh that lacks a triangle must not pass.
TEST(BrokenMeshes, OneTriangleLessIsNoticed) {
  for (const std::string& name : names()) {
    BrokenMesh mesh = make_broken_mesh({{name}, 2});
    mesh.soup.triangles.pop_back();
    EXPECT_NE(counts(found_in(mesh.soup)), counts(mesh.known)) << name;
  }
}

template <typename Action>
std::string input_error(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(BrokenMeshes, WhatCannotBeIsRefused) {
  EXPECT_NE(input_error([] {
              make_broken_mesh({{"whole"}, 1});
            }).find("there are none, hole, holes"),
            std::string::npos);
  EXPECT_NE(input_error([] { make_broken_mesh({{}, 1}); }).find("at least one defect"), std::string::npos);
  EXPECT_NE(input_error([] { make_broken_mesh({{"none"}, 0}); }).find("from 1 to 2048"), std::string::npos);
  EXPECT_NE(input_error([] { make_broken_mesh({{"none"}, 0xffffffffu}); }).find("from 1 to 2048"), std::string::npos);
  EXPECT_NE(input_error([] {
              make_broken_mesh({{"hole", "nested"}, 2048});
            }).find("at most 50000000"),
            std::string::npos);
}

/// A gap that remains in float32, one that does not, and zeros of both signs.
TEST(BrokenMeshes, GapsAndZerosAreThere) {
  const auto vertices_in_float = [](const std::string& name) {
    const BrokenMesh mesh = make_broken_mesh({{name}, 3});
    std::set<std::tuple<float, float, float>> places;
    for (const Triangle& t : mesh.soup.triangles) {
      for (const std::uint32_t corner : t) {
        const glm::vec3 p(mesh.soup.positions[corner]);
        places.emplace(p.x, p.y, p.z);
      }
    }
    return mesh.known.vertices - places.size();
  };
  EXPECT_EQ(vertices_in_float("gap"), 0u);
  EXPECT_EQ(vertices_in_float("lost-gap"), 8u);  // all vertices around a patch of two cells
  const auto& positions = make_broken_mesh({{"negative-zero"}, 3}).soup.positions;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool sign : {false, true}) {
      EXPECT_TRUE(std::any_of(positions.begin(), positions.end(),
                              [&](const glm::dvec3& p) { return p[axis] == 0 && std::signbit(p[axis]) == sign; }));
    }
  }
}

TEST(LatticeSoups, AreAFunctionOfTheirParameters) {
  const TriangleSoup soup = make_lattice_soup({100, 3, 7});
  EXPECT_EQ(soup.positions, make_lattice_soup({100, 3, 7}).positions);
  EXPECT_NE(soup.positions, make_lattice_soup({100, 3, 8}).positions);
  EXPECT_EQ(soup.triangles.size(), 100u);
  EXPECT_EQ(soup.object, std::vector<std::uint32_t>(100, 0));
  // The first corners for seed 7 are the same on every platform: mt19937 is specified, distributions are not.
  std::mt19937 random(7);
  for (int i = 0; i < 9; ++i) {
    const glm::dvec3& p = soup.positions[static_cast<std::size_t>(i / 3)];
    EXPECT_EQ(p[i % 3], 0.5 * (static_cast<double>(random() % 4) - 1.5));
  }
}

/// Coincidences are the rule: among any two hundred triangles on a lattice of 27 points there are some of each kind.
TEST(LatticeSoups, HaveCoincidences) {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    const KnownDiagnosis found = found_in(make_lattice_soup({200, 2, seed}));
    EXPECT_LE(found.vertices, 27u) << seed;
    EXPECT_GT(found.non_manifold_edges, 0u) << seed;
    EXPECT_GT(found.zero_area_triangles, 0u) << seed;
    EXPECT_GT(found.t_junctions, 0u) << seed;
    EXPECT_GT(found.self_intersections, 0u) << seed;
  }
}

}  // namespace
}  // namespace penumbra::mesh
