// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/method_row.hpp"
#include "session/machine.hpp"
#include "visibility/method.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::session {

/// Returns all methods of this build, in the order of `penumbra methods`, then added ones. Callable without a Vulkan
/// device.
std::vector<const visibility::MethodDescription*> all_methods();

/// Adds a method to those of this process, for the process's lifetime. Thread-safe with look-ups. Throws UsageError for
/// a name that is taken.
void add_method(engines::MethodRow row);

/// Returns the members of `reference`, `geometry`, `image`, `all`, or `default` (geometry-based and image-based methods
/// that do not take minutes); nullopt for any other word.
std::optional<std::vector<const visibility::MethodDescription*>> method_group(std::string_view group);

/// Returns the description of a method. Throws UsageError, with the list of methods, for an unknown name.
const visibility::MethodDescription& describe_method(std::string_view name);

/// Returns the description of a method with these options, on which its output and its lights may depend. Throws
/// UsageError for unknown options, invalid values, and options that exclude each other.
visibility::MethodDescription describe_method(std::string_view name, const visibility::MethodOptions& options);

/// Returns the names of the family `reference`.
std::vector<std::string> judge_names();
/// Returns a member of the family `reference`, against which methods are compared. Throws UsageError, about the option
/// --reference, for any other name.
const visibility::MethodDescription& describe_judge(std::string_view name);
/// Returns the reference with masks: pairs of all methods with masks are compared with it, light sample by light
/// sample.
const visibility::MethodDescription& ray_judge();

/// Returns whether the method runs on the Vulkan device, with these options and for this light, and not on the
/// processor. Looks for a GPU only for a method that may run on either.
bool runs_on_device(std::string_view name, const visibility::MethodOptions& options, const visibility::Light& light,
                    const render::Machine& machine);

/// Returns whether the method is slow where the Vulkan device is a processor (MethodRow::slow_on_processors).
bool is_slow_on_processors(std::string_view name);

/// Returns whether the method runs only on a Vulkan device, for any light.
bool needs_device(std::string_view name, const visibility::MethodOptions& options);

/// Checks the options, then makes the method. The machine's device is opened only for methods that run on a device.
std::unique_ptr<visibility::Method> make_method(std::string_view name, const visibility::MethodOptions& options,
                                                const render::Machine& machine);

/// Returns whether a method, with these options, can be given all triangles once, without keeping any
/// (visibility::PassesTriangles): for planar lights and suns, in scenes without holes and translucent surfaces.
bool passes_triangles(std::string_view name, const visibility::MethodOptions& options);

/// Does visibility::check_light for a method with these options, described by `description`. If a single option
/// prevents the method from supporting this kind of light, the error names the option.
void check_light(const visibility::MethodDescription& description, const visibility::MethodOptions& options,
                 const visibility::Light& light);

bool can_do(const visibility::MethodDescription& method, const std::vector<visibility::Light>& lights);

/// Returns the best method for the light's samples: the first geometry-based one that supports the light; rays, if the
/// light is beyond that method's range (LightSpan) or of an unsupported kind; `exact`, which computes areas of any
/// light, if rays do not support it either. Throws InputError if there is no method. `scene`: null if the light's range
/// does not matter. `triangles`: number of triangles of the whole scene, of which `scene` may be a part.
const visibility::MethodDescription& default_method(const visibility::Light& light,
                                                    const visibility::SceneFloats* scene = nullptr,
                                                    std::uint64_t triangles = 0);

}  // namespace penumbra::session
