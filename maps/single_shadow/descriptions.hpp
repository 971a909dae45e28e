// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Common part of the descriptions of this room's methods: V from one shadow map of a planar light's centre.
/// Comparisons leave these methods out unless they name them.
namespace penumbra::maps {

struct SingleShadow {
  std::string name, paper, exact_for;
  std::vector<visibility::OptionDescription> options;
  visibility::MeshVerdict (*verdict_on)(const mesh::Diagnosis& mesh) = nullptr;
  visibility::ErrorRepairs (*repairs)(const visibility::MethodDescription& method,
                                      const visibility::MethodOptions& given) = nullptr;
};
visibility::MethodDescription single_shadow_description(SingleShadow method);

/// Returns the verdict of methods whose penumbrae lie only outside of the hard shadow.
visibility::MeshVerdict outer_verdict(const mesh::Diagnosis& mesh);

/// Return MethodDescription::repairs of methods whose search is not given in texels, and of those whose search is.
visibility::ErrorRepairs single_shadow_repairs(const visibility::MethodDescription& method,
                                               const visibility::MethodOptions& given);
visibility::ErrorRepairs searched_shadow_repairs(const visibility::MethodDescription& method,
                                                 const visibility::MethodOptions& given);

/// Returns MethodDescription::warning of methods whose search ends at the option `radius`: a search that reaches this
/// limit cuts V.
std::optional<std::string> cut_search_warning(const visibility::MethodOptions& options,
                                              const std::map<std::string, std::uint64_t>& counters);

}  // namespace penumbra::maps
