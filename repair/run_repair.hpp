#pragma once

#include "mesh/repair.hpp"

namespace penumbra::repair {

/// The work of `penumbra-repair`: what mesh::repair promises, in this process. `options.weld` is a length of 0 or more.
mesh::Repaired run_repair(const mesh::TriangleSoup& soup, const mesh::RepairOptions& options);

}  // namespace penumbra::repair
