// SPDX-License-Identifier: Apache-2.0
// Reads counters of a look-up's work.

#include "maps/products/work_counts.hpp"

#include <utility>

namespace penumbra::maps {

WorkCounts::WorkCounts(const render::Device& device, std::vector<std::string> names)
    : names_(std::move(names)), counts_(device, "work counts", names_.size() * sizeof(std::uint64_t)) {}

void WorkCounts::make(const MapSource& /*source*/) {
  counts_.write<std::uint64_t>(std::vector<std::uint64_t>(names_.size()));
}

void WorkCounts::add_counters(std::map<std::string, std::uint64_t>& counters) const {
  std::vector<std::uint64_t> counts(names_.size());
  counts_.read<std::uint64_t>(counts);
  for (std::size_t i = 0; i < names_.size(); ++i) counters[names_[i]] = counts[i];
}

}  // namespace penumbra::maps
