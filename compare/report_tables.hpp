#pragma once

#include "compare/report.hpp"

#include <optional>
#include <string>
#include <vector>

/// The report's tables of numbers, and what they share with its other sections. Internal to this room.
namespace penumbra::compare {

/// Did the entry answer what the reference was asked, with as many light samples? Only then are seconds compared.
bool same_question(const ReportInput& in, const ReportEntry& entry, const MethodResult& result);

/// The label of the method in tables and captions; `small` is a second, paler line.
std::string label_html(const std::string& name, const std::string& small);

/// The entries whose number is smallest as it is shown: more than one where they tie. Of numbers that look the same
/// none is called better.
using NumberOf = std::optional<double> (*)(const MethodResult&);
using TextOf = std::string (*)(double);
std::vector<const MethodResult*> smallest(const std::vector<MethodResult>& results, NumberOf number_of, TextOf text_of);

/// How rays on the methods' light samples are called: "raytrace, 256 light samples".
std::string rays_label(const ReportInput& in);

/// Of V over all lights.
std::optional<double> rmse_of(const MethodResult& result);
std::optional<double> shadow_of(const MethodResult& result);

/// Failures, errors of V, pairs, seconds, passes and counters: a table each.
std::string number_tables_html(const ReportInput& in);

}  // namespace penumbra::compare
