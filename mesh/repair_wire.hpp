// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import_wire.hpp"
#include "mesh/repair.hpp"

/// Request to `penumbra-repair`, and its answer.
namespace penumbra::mesh {

/// Writes a request. The soup must stay unchanged until the writer's pieces have been used.
void put_repair_request(WireWriter& to, const TriangleSoup& soup, const RepairOptions& options);
/// A request read from the wire. Reading throws WireError, as get_soup does.
struct RepairRequest {
  TriangleSoup soup;
  RepairOptions options;
};
RepairRequest get_repair_request(WireReader& from);

/// Writes a result. The soup must stay unchanged until the writer's pieces have been used.
void put_repaired(WireWriter& to, const Repaired& repaired);
/// Reads a result. Throws WireError, as get_soup does.
Repaired get_repaired(WireReader& from);

}  // namespace penumbra::mesh
