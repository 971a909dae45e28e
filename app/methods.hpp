#pragma once

#include "app/machine.hpp"
#include "engines/method_row.hpp"
#include "visibility/method.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::app {

/// All methods of this build, in the order of `penumbra methods`, then those that were added. Needs no device.
std::vector<const visibility::MethodDescription*> all_methods();

/// Adds a method to those of this process, for its life. Safe while other threads look methods up. Throws UsageError
/// for a name that is taken.
void add_method(engines::MethodRow row);

/// The members of `reference`, `geometry`, `image`, `all`, or `default` (geometry-based and image-based ones that do
/// not take minutes); nothing for any other word.
std::optional<std::vector<const visibility::MethodDescription*>> method_group(std::string_view group);

/// Throws UsageError, listing what is there, for an unknown name.
const visibility::MethodDescription& describe_method(std::string_view name);

/// The description of a method run with these options: its output and its lights may depend on them. Throws
/// UsageError for options that it does not have, values that they cannot have, and options that exclude each other.
visibility::MethodDescription describe_method(std::string_view name, const visibility::MethodOptions& options);

/// The names of the family `reference`.
std::vector<std::string> judge_names();
/// A member of the family `reference`, against which others are held. Throws UsageError, about the option --reference,
/// for any other name.
const visibility::MethodDescription& describe_judge(std::string_view name);
/// The one with masks: pairs of all methods with masks are held against it, light sample by light sample.
const visibility::MethodDescription& ray_judge();

/// Whether the method runs on the Vulkan device, with these options and for this light, and not on the processor. Looks
/// for a GPU only for a method that may run on either.
bool runs_on_device(std::string_view name, const visibility::MethodOptions& options, const visibility::Light& light,
                    const render::Machine& machine);

/// Whether the method runs on a Vulkan device alone, whatever the light.
bool needs_device(std::string_view name, const visibility::MethodOptions& options);

/// Checks the options, then builds the method. Only methods that run on a device make the machine's.
std::unique_ptr<visibility::Method> make_method(std::string_view name, const visibility::MethodOptions& options,
                                                const render::Machine& machine);

bool can_do(const visibility::MethodDescription& method, const std::vector<visibility::Light>& lights);

/// The best method for the light's samples: the first geometry-based one that can do it; of a light that it cannot hold
/// beside the scene (LightSpan), or of a kind that none can do, rays. Where these cannot hold it either, `exact`, which
/// has areas of any light. Throws InputError if there is none either.
/// `scene`: null for a light of no size.
const visibility::MethodDescription& default_method(const visibility::Light& light,
                                                    const visibility::SceneFloats* scene = nullptr);

}  // namespace penumbra::app
