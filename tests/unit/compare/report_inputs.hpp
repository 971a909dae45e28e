// SPDX-License-Identifier: Apache-2.0
#pragma once

// Makes reports of invented results, and examines their pages.

#include "compare/report.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace penumbra::compare {

inline std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

inline Image8 picture(std::uint8_t value) {
  return {2, 2, std::vector<Color8>(4, {value, value, value})};
}

inline MethodResult result_of(const std::string& entry) {
  MethodResult result;
  result.entry = entry;
  result.stats.scene = "bunny.json";
  result.stats.method = entry;
  result.stats.device = "llvmpipe";
  result.stats.width = result.stats.height = 512;
  result.stats.light_samples = 256;
  result.stats.sample_pattern = "rows";
  result.stats.seconds.light = 0.5;
  result.stats.seconds.evaluate = 1.5;
  result.stats.passes = {{"test & count", 1234.0}};
  result.stats.counters = {{"candidates", 1234567}};
  result.error = VisibilityError{0.0012, 0.0034, 0.05, 0.5, 0.001, -0.0002};
  result.all_lights_error = result.error;
  result.lights = {{"key", 200000, 0, result.error, {}, {}, {}}};
  return result;
}

inline ReportInput input_with(std::size_t method_count) {
  ReportInput in;
  in.version = "1.2.3";
  in.arguments = {"compare", "scenes/my scene.json", "-o", "out"};
  in.view_arguments = {"view", "scenes/my scene.json"};
  in.scene = {{"Triangles", "69 666"}};
  in.metrics.reference = result_of("raytrace").stats;
  in.metrics.reference.seconds.evaluate = 3.5;
  in.metrics.judged_pixels = 200000;
  in.reference.description.name = "raytrace";
  in.lights.push_back({.name = "key"});
  in.reference.lights.emplace_back();
  for (std::size_t i = 0; i < method_count; ++i) {
    in.metrics.methods.push_back(result_of("method-" + std::to_string(i)));
    ReportEntry entry;
    entry.description.name = "method-" + std::to_string(i);
    entry.lights.emplace_back();
    in.methods.push_back(entry);
  }
  in.error_limit = 0.5;
  return in;
}

/// Returns the first tag that is not closed where it should be; "" if all are.
inline std::string unbalanced_tag(const std::string& html) {
  const std::vector<std::string> never_closed{"meta", "img", "input", "br", "!DOCTYPE"};
  std::vector<std::string> open;
  bool in_script = false;  // a script's text is not markup until it ends
  std::size_t at = 0;
  while ((at = html.find('<', at)) != std::string::npos) {
    if (in_script && html.compare(at, 9, "</script>") != 0) {
      ++at;
      continue;
    }
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return html.substr(at, 40);
    const bool closing = html[at + 1] == '/';
    const std::size_t first = at + (closing ? 2 : 1);
    const std::string name = html.substr(first, html.find_first_of(" />\n", first) - first);
    in_script = !closing && name == "script";
    const bool alone =
        html[end - 1] == '/' || std::find(never_closed.begin(), never_closed.end(), name) != never_closed.end();
    if (closing) {
      if (open.empty() || open.back() != name) return "/" + name;
      open.pop_back();
    } else if (!alone) {
      open.push_back(name);
    }
    at = end + 1;
  }
  return open.empty() ? "" : open.back();
}

/// Returns input with numbers for the page's script: 2 × 2 pixels, masks of four light samples, `lights` lights.
inline ReportInput touchable_input(std::size_t method_count, std::size_t light_count = 1) {
  ReportInput in = input_with(method_count);
  in.metrics.reference.width = in.metrics.reference.height = 2;
  in.lights.clear();
  for (std::size_t i = 0; i < light_count; ++i) {
    ReportLight& light = in.lights.emplace_back();
    light.name = "light " + std::to_string(i);
    light.packed_classes = "Q0xBU1M=";
    light.samples = {{-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}};
  }
  const auto fill = [&](ReportEntry& entry) {
    entry.packed_beauty = "QkVBVVRZ";
    entry.lights.resize(light_count);
    for (ReportLightView& view : entry.lights) {
      view.packed_visibility = "Vg==";
      view.packed_masks = "TQ==";
    }
  };
  fill(in.reference);
  for (ReportEntry& entry : in.methods) fill(entry);
  for (MethodResult& result : in.metrics.methods) {
    result.lights.resize(light_count, result.lights.front());
    for (std::size_t i = 0; i < light_count; ++i) result.lights[i].name = in.lights[i].name;
  }
  return in;
}

}  // namespace penumbra::compare
