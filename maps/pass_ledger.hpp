#pragma once

#include "render/commands.hpp"
#include "visibility/method.hpp"

#include <vector>

namespace penumbra::maps {

/// Sums the times of passes by name, in the order in which they first ran.
class PassLedger {
 public:
  void add(const std::vector<render::PassMilliseconds>& passes);
  /// What was added since the last call.
  std::vector<visibility::PassTime> take();

 private:
  std::vector<visibility::PassTime> times_;
};

}  // namespace penumbra::maps
