// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"

#include <map>
#include <string>
#include <vector>

namespace penumbra::maps {

/// Counters of a look-up's work over all its calls: a number of 64 bits for each name, in two words, the lower one
/// first.
class WorkCounts final : public MapProduct {
 public:
  WorkCounts(const render::Device& device, std::vector<std::string> names);
  void make(const MapSource& source) override;
  void record(render::Commands& /*commands*/, const MapSet& /*maps*/) override {}
  [[nodiscard]] const render::Buffer& buffer() const override { return counts_; }
  void add_counters(std::map<std::string, std::uint64_t>& counters) const override;

 private:
  std::vector<std::string> names_;
  render::Buffer counts_;
};

}  // namespace penumbra::maps
