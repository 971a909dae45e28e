#pragma once

#include "mesh/triangle_soup.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::mesh {

struct RepairOptions {
  double weld = 0;                          ///< join vertices at most this far apart (the file's unit)
  std::uint32_t fill_holes_up_to = 0;       ///< edges around a hole; 0: leave all
  bool resolve_self_intersections = false;  ///< replace triangles that cross others of their part; moves the surface by
                                            ///< at most 1 % of the part's diagonal
};

struct RepairStep {
  std::string what;  ///< "removed", "stitched", …: a sentence with the count
  std::uint64_t count = 0;
};

struct Repaired {
  TriangleSoup soup;
  std::vector<RepairStep> done;   ///< each thing it did; empty if there was nothing to do
  std::vector<std::string> left;  ///< what it could not repair, with counts
};

/// Removes zero-area and duplicate triangles, merges equal vertices, splits non-manifold vertices and edges, orients
/// neighbours alike and closed parts outward, stitches borders that coincide, fills holes up to a size, and on request
/// resolves self-intersections. The input is never changed. Objects keep their numbers.
///
/// The program `penumbra-repair` does it, in a process of its own: it contains CGAL's GPL packages, which neither the
/// library nor the program `penumbra` is to be a work with. Throws UsageError if a length or a number cannot be meant,
/// ResourceError if that program is missing, cannot be started or crashes.
Repaired repair(const TriangleSoup& soup, const RepairOptions& options);

/// Throws ResourceError where repair() would because `penumbra-repair` is missing: before long work begins.
void require_repair();

}  // namespace penumbra::mesh
