// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::mesh {

struct RepairOptions {
  double weld = 0;                          ///< merges vertices at most this far apart (the file's unit)
  std::uint32_t fill_holes_up_to = 0;       ///< largest number of edges around a hole that is filled; 0: no hole is
  bool resolve_self_intersections = false;  ///< replace triangles that cross others of their part; moves the surface by
                                            ///< at most 1 % of the part's diagonal
};

struct RepairStep {
  std::string what;  ///< "removed", "stitched", …: forms a sentence with the count
  std::uint64_t count = 0;
};

struct Repaired {
  TriangleSoup soup;
  std::vector<RepairStep> done;   ///< each change made; empty if nothing had to be repaired
  std::vector<std::string> left;  ///< defects that could not be repaired, with counts
};

/// Removes zero-area and duplicate triangles, merges equal vertices, splits non-manifold vertices and edges, orients
/// neighbours consistently and closed parts outward, stitches coinciding borders, fills holes up to a size, and on
/// request resolves self-intersections. The input is never changed. Objects keep their numbers.
///
/// The program `penumbra-repair` does the work, in a separate process: it contains CGAL's GPL packages, which must not
/// become part of the library or of the program `penumbra`. Throws UsageError if a length or a number is out of range,
/// ResourceError if that program is missing, cannot be started or crashes.
Repaired repair(const TriangleSoup& soup, const RepairOptions& options);

/// Throws the ResourceError of repair() if `penumbra-repair` is missing; call before long work begins.
void require_repair();

}  // namespace penumbra::mesh
