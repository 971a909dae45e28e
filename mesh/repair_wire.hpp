#pragma once

#include "mesh/import_wire.hpp"
#include "mesh/repair.hpp"

/// What is asked of `penumbra-repair`, and what it answers.
namespace penumbra::mesh {

/// The soup must stay as it is until the writer's pieces have been used.
void put_repair_request(WireWriter& to, const TriangleSoup& soup, const RepairOptions& options);
/// Throws WireError, as get_soup does.
struct RepairRequest {
  TriangleSoup soup;
  RepairOptions options;
};
RepairRequest get_repair_request(WireReader& from);

/// As put_repair_request.
void put_repaired(WireWriter& to, const Repaired& repaired);
/// Throws WireError, as get_soup does.
Repaired get_repaired(WireReader& from);

}  // namespace penumbra::mesh
