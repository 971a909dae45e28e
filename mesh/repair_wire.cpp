// SPDX-License-Identifier: Apache-2.0
// Request and answer of `penumbra-repair`, field by field; both processes are built from this file.

#include "mesh/repair_wire.hpp"

namespace penumbra::mesh {

void put_repair_request(WireWriter& to, const TriangleSoup& soup, const RepairOptions& options) {
  to.put(options.weld);
  to.put(options.fill_holes_up_to);
  to.put<std::uint8_t>(options.resolve_self_intersections ? 1 : 0);
  put_soup(to, soup);
}

RepairRequest get_repair_request(WireReader& from) {
  RepairRequest request;
  request.options.weld = from.get<double>();
  request.options.fill_holes_up_to = from.get<std::uint32_t>();
  request.options.resolve_self_intersections = from.get_bool();
  request.soup = get_soup(from);
  return request;
}

void put_repaired(WireWriter& to, const Repaired& repaired) {
  put_soup(to, repaired.soup);
  to.put<std::uint64_t>(repaired.done.size());
  for (const RepairStep& step : repaired.done) {
    to.put_string(step.what);
    to.put(step.count);
  }
  to.put_strings(repaired.left);
}

Repaired get_repaired(WireReader& from) {
  Repaired repaired;
  repaired.soup = get_soup(from);
  for (auto steps = from.get<std::uint64_t>(); steps > 0; --steps) {
    std::string what = from.get_string();
    repaired.done.push_back({std::move(what), from.get<std::uint64_t>()});
  }
  repaired.left = from.get_strings();
  return repaired;
}

}  // namespace penumbra::mesh
