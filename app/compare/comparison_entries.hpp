#pragma once

#include "app/compare/comparison.hpp"
#include "app/output.hpp"
#include "app/runner.hpp"
#include "app/session.hpp"
#include "render/machine.hpp"
#include "visibility/method.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// A method as asked for, with what its options make of it.
struct Entry {
  std::string label;
  visibility::MethodDescription description;
  visibility::MethodOptions options;
};

/// The methods with the options that are for all of them (ComparisonOptions::method_options). Throws UsageError for one
/// that none has.
std::vector<MethodEntry> with_method_options(const ComparisonOptions& options);
/// The entry that judges: a member of the family `reference`, or a method that gives exact areas with these options
/// (NAME:key=value). Throws UsageError for any other.
Entry describe_reference(const std::string& text);
/// The first method that gives exact areas by options, as one names it with --methods or --reference.
std::string exact_area_example();

/// The chosen methods, each with the options of --method-option that it has. Refuses, before anything long, what would
/// fail later; leaves out of a group, with a warning to `warn`, what cannot do the lights, and what needs a Vulkan
/// device where there is none.
std::vector<Entry> choose_entries(const ComparisonOptions& options, const Session& session,
                                  const render::Machine& machine, const std::function<void(std::string)>& warn);

/// UsageError if none of these methods says what repairs its error.
void require_explainable(std::span<const MethodEntry> methods);

/// How often an entry runs: as often as was asked for, else as often as runs begin within two seconds, at most five
/// times, after a discarded one; a judge that gives areas once. Lights and pixels are the caller's.
RunPlan plan_of(const Entry& entry, bool is_reference, const ComparisonOptions& options);

/// One label a light: where a method runs may depend on the light.
std::vector<MethodLabel> labels_of(const Entry& entry, std::span<const visibility::Light> lights,
                                   const render::Machine& machine);

/// --bits were asked for, and the method has some.
bool wants_bits(const Entry& entry, const ComparisonOptions& options);

}  // namespace penumbra::app
