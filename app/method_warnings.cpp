#include "app/method_warnings.hpp"

#ifdef PENUMBRA_HAS_MAPS
#include "maps/backprojection/soft_shadow_map/soft_shadow_map.hpp"
#endif

#include <optional>

namespace penumbra::app {

std::vector<std::string> method_warnings([[maybe_unused]] std::string_view method,
                                         [[maybe_unused]] const visibility::MethodOptions& options,
                                         [[maybe_unused]] const std::map<std::string, std::uint64_t>& counters) {
  std::vector<std::string> warnings;
#ifdef PENUMBRA_HAS_MAPS
  if (method == "soft-shadow-map") {
    if (auto warning = maps::soft_shadow_map_warning(options, counters)) warnings.push_back(*std::move(warning));
  }
#endif
  return warnings;
}

}  // namespace penumbra::app
