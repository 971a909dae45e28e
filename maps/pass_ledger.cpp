#include "maps/pass_ledger.hpp"

#include <algorithm>
#include <utility>

namespace penumbra::maps {

void PassLedger::add(const std::vector<render::PassMilliseconds>& passes) {
  for (const auto& [name, milliseconds] : passes) {
    const auto found =
        std::find_if(times_.begin(), times_.end(), [&n = name](const auto& time) { return time.name == n; });
    if (found != times_.end()) {
      found->milliseconds += milliseconds;
    } else {
      times_.push_back({name, milliseconds});
    }
  }
}

std::vector<visibility::PassTime> PassLedger::take() {
  return std::exchange(times_, {});
}

}  // namespace penumbra::maps
