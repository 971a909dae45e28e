#pragma once

#include "compare/report.hpp"

#include <optional>
#include <string>
#include <vector>

/// Tables of numbers in the report, and functions common with its other sections. Internal to this room.
namespace penumbra::compare {

/// Returns whether the entry computes the quantity of the reference, with as many light samples. Only then are seconds
/// compared.
bool same_question(const ReportInput& in, const ReportEntry& entry, const MethodResult& result);

/// Returns the label of the method in tables and captions; `small` is a second, paler line.
std::string label_html(const std::string& name, const std::string& small);

/// Returns the entries with the smallest number, compared as displayed: more than one if these are equal, so that no
/// displayed tie has a winner.
using NumberOf = std::optional<double> (*)(const MethodResult&);
using TextOf = std::string (*)(double);
std::vector<const MethodResult*> smallest(const std::vector<MethodResult>& results, NumberOf number_of, TextOf text_of);

/// Returns the label of rays on the methods' light samples: "raytrace, 256 light samples".
std::string rays_label(const ReportInput& in);

/// Return RMSE of V over all lights, and the seconds for the shadow; nullopt if unknown.
std::optional<double> rmse_of(const MethodResult& result);
std::optional<double> shadow_of(const MethodResult& result);

/// Returns failures, errors of V, pairs, seconds, passes and counters: one table each.
std::string number_tables_html(const ReportInput& in);

}  // namespace penumbra::compare
