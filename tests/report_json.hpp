// SPDX-License-Identifier: Apache-2.0
#pragma once

// Reads the JSON in a report's page, from which the page's script draws.

#include <nlohmann/json.hpp>

#include <string>

namespace penumbra::tests {

inline nlohmann::json report_json(const std::string& html) {
  const std::string begin = "<script type=\"application/json\" id=\"report-data\">";
  const std::size_t first = html.find(begin) + begin.size();
  return nlohmann::json::parse(html.substr(first, html.find("</script>", first) - first));
}

}  // namespace penumbra::tests
