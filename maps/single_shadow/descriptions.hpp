#pragma once

#include "visibility/method.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// What the descriptions of this room's methods have in common: V from one shadow map of a planar light's centre, left
/// out of comparisons that do not name them.
namespace penumbra::maps {

struct SingleShadow {
  std::string name, paper, exact_for;
  std::vector<visibility::OptionDescription> options;
  visibility::MeshVerdict (*verdict_on)(const mesh::Diagnosis& mesh) = nullptr;
  visibility::ErrorRepairs (*repairs)(const visibility::MethodDescription& method,
                                      const visibility::MethodOptions& given) = nullptr;
};
visibility::MethodDescription single_shadow_description(SingleShadow method);

/// The verdict of methods whose penumbrae lie outside of the hard shadow alone.
visibility::MeshVerdict outer_verdict(const mesh::Diagnosis& mesh);

/// MethodDescription::repairs of methods whose search is not counted in texels, and of those whose search is.
visibility::ErrorRepairs single_shadow_repairs(const visibility::MethodDescription& method,
                                               const visibility::MethodOptions& given);
visibility::ErrorRepairs searched_shadow_repairs(const visibility::MethodDescription& method,
                                                 const visibility::MethodOptions& given);

/// MethodDescription::warning of methods whose search ends at the option `radius`: where it does, V is cut.
std::optional<std::string> cut_search_warning(const visibility::MethodOptions& options,
                                              const std::map<std::string, std::uint64_t>& counters);

}  // namespace penumbra::maps
