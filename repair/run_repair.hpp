// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/repair.hpp"

namespace penumbra::repair {

/// Does the work of `penumbra-repair`, described at mesh::repair, in the current process. `options.weld` is a length of
/// 0 or more.
mesh::Repaired run_repair(const mesh::TriangleSoup& soup, const mesh::RepairOptions& options);

}  // namespace penumbra::repair
