#pragma once

#include "visibility/method_options.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// What a run's counters say that a viewer of its picture must know; mostly nothing. `options`: as given or all of
/// them.
std::vector<std::string> method_warnings(std::string_view method, const visibility::MethodOptions& options,
                                         const std::map<std::string, std::uint64_t>& counters);

}  // namespace penumbra::app
