// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/machine.hpp"
#include "session/comparison/comparison.hpp"
#include "session/output.hpp"
#include "session/runner.hpp"
#include "session/session.hpp"
#include "visibility/method.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Method as requested, with its description for these options.
struct Entry {
  std::string label;
  visibility::MethodDescription description;
  visibility::MethodOptions options;
  bool from_group = false;  ///< requested as a member of a group, not by name
};

/// Returns the methods with the options given for all of them (ComparisonOptions::method_options). Throws UsageError
/// for an option that no method has.
std::vector<MethodEntry> with_method_options(const ComparisonOptions& options);
/// Returns the reference's entry: a member of the family `reference`, or a method that computes exact areas with these
/// options (NAME:key=value). Throws UsageError for any other.
Entry describe_reference(const std::string& text);
/// Returns the first method that computes exact areas by options, in the form of --methods or --reference.
std::string exact_area_example();

/// Returns the chosen methods, each with those options of --method-option that it has. Throws before any long work for
/// entries that would fail later; leaves out of a group, with a warning to `warn`, methods that do not support the
/// lights, and methods that need a Vulkan device where there is none.
std::vector<Entry> choose_entries(const ComparisonOptions& options, const Session& session,
                                  const render::Machine& machine, const std::function<void(std::string)>& warn);

/// Throws UsageError if none of these methods describes repairs of its error.
void require_explainable(std::span<const MethodEntry> methods);

/// Returns the number of runs of an entry: the requested number, else as many as fit into two seconds, one to
/// five, after a discarded one; one for a judge that computes areas. The caller sets lights and pixels.
RunPlan plan_of(const Entry& entry, bool is_reference, const ComparisonOptions& options);

/// Returns the entry with the options that its method changed itself in a run (visibility::ChangesDefaults).
Entry as_run(Entry entry, const MethodRun& run);

/// Returns one label for each light, which refers to `entry`: the device of a method may depend on the light.
std::vector<MethodLabel> labels_of(const Entry& entry, std::span<const visibility::Light> lights,
                                   const render::Machine& machine);

/// Returns whether --bits were requested, and the method has masks.
bool wants_bits(const Entry& entry, const ComparisonOptions& options);

}  // namespace penumbra::session
