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

/// The entry for which `value_of` (an optional number) is smallest.
template <typename ValueOf>
const MethodResult* smallest(const std::vector<MethodResult>& results, ValueOf value_of) {
  const MethodResult* best = nullptr;
  for (const MethodResult& result : results) {
    if (value_of(result) && (best == nullptr || *value_of(result) < *value_of(*best))) best = &result;
  }
  return best;
}

std::optional<double> rmse_of(const MethodResult& result);
std::optional<double> shadow_of(const MethodResult& result);

/// Failures, errors of V, pairs, seconds, passes and counters: a table each.
std::string number_tables_html(const ReportInput& in);

}  // namespace penumbra::compare
