// SPDX-License-Identifier: Apache-2.0
// Parses options common to several commands.

#include "session/options.hpp"

#include "base/error.hpp"
#include "scenes/formats/checks.hpp"
#include "session/methods.hpp"
#include "session/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace penumbra::session {
namespace {

constexpr std::uint32_t kMostLightSamples = 4096;
constexpr std::uint32_t kLongestSide = 32768;

/// Parses "AxB"; returns nullopt for any other text.
std::optional<std::pair<std::uint32_t, std::uint32_t>> parse_product(std::string_view text) {
  const auto x = text.find('x');
  if (x == std::string_view::npos) return std::nullopt;
  const auto first = parse_integer<std::uint32_t>(text.substr(0, x));
  const auto second = parse_integer<std::uint32_t>(text.substr(x + 1));
  if (!first || !second) return std::nullopt;
  return std::pair{*first, *second};
}

void insert_option(visibility::MethodOptions& options, std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw UsageError("method option \"{}\": expected KEY=VALUE; `penumbra methods` lists each method's keys", text);
  }
  const auto [place, inserted] = options.emplace(text.substr(0, equals), text.substr(equals + 1));
  if (!inserted) throw UsageError("method option \"{}\" is given twice", place->first);
}

visibility::SamplePattern parse_pattern(const std::string& text) {
  using visibility::SamplePattern;
  for (const SamplePattern pattern :
       {SamplePattern::rows, SamplePattern::grid, SamplePattern::sobol, SamplePattern::jittered, SamplePattern::rgss}) {
    if (text == visibility::name_of(pattern)) return pattern;
  }
  throw UsageError("--sample-pattern {}: expected rows, grid, sobol, jittered or rgss", text);
}

}  // namespace

std::string file_name_of(std::string_view label) {
  std::string name(label);
  std::ranges::replace_if(
      name,
      [](unsigned char c) {
        return std::isalnum(c) == 0 && std::string_view("-_.=:+").find(static_cast<char>(c)) == std::string_view::npos;
      },
      '_');
  return name;
}

scenes::ReadOptions read_options(const GltfOptions& gltf, bool allow_outside) {
  if (gltf.radius && !(*gltf.radius > 0 && *gltf.radius <= scenes::kLargestCoordinate)) {
    throw UsageError("--lamp-radius {}: expected a length above 0", *gltf.radius);
  }
  if (gltf.sun_angle && !(*gltf.sun_angle >= 0 && *gltf.sun_angle < 180)) {
    throw UsageError("--sun-angle {}: expected degrees from 0 to less than 180", *gltf.sun_angle);
  }
  if (gltf.lumens_per_watt && !(*gltf.lumens_per_watt > 0 && *gltf.lumens_per_watt <= 1e6)) {
    throw UsageError("--lumens-per-watt {}: expected a number above 0, such as 683", *gltf.lumens_per_watt);
  }
  scenes::ReadOptions read;
  read.allow_outside = allow_outside;
  read.lamp_radius = gltf.radius;
  read.sun_angle = gltf.sun_angle;
  read.lumens_per_watt = gltf.lumens_per_watt;
  read.clips = gltf.clips;
  return read;
}

visibility::SampleRequest parse_light_samples(const RunOptions& options) {
  visibility::SampleRequest request;
  if (!options.sample_pattern.empty()) request.pattern = parse_pattern(options.sample_pattern);
  request.seed = options.sample_seed;
  const std::string& text = options.light_samples;
  if (text.empty()) return request;
  if (const auto product = parse_product(text)) {
    request.rows = product->first;
    request.columns = product->second;
    const std::uint64_t count = std::uint64_t{request.rows} * request.columns;
    if (count == 0 || count > kMostLightSamples) {
      throw UsageError("--light-samples {}: {} points; expected 1 to {}", text, count, kMostLightSamples);
    }
    request.count = static_cast<std::uint32_t>(count);
    return request;
  }
  const auto count = parse_integer<std::uint32_t>(text);
  if (!count || *count == 0 || *count > kMostLightSamples) {
    throw UsageError("--light-samples {}: expected a number from 1 to {}, or LxB such as 16x16", text,
                     kMostLightSamples);
  }
  request.count = *count;
  return request;
}

bool parse_normals(const std::string& text) {
  if (!text.empty() && text != "geometric" && text != "shading")
    throw UsageError("--normals {}: expected geometric or shading", text);
  return text != "geometric";
}

std::pair<std::uint32_t, std::uint32_t> parse_size(std::string_view text) {
  const auto size = parse_product(text);
  if (!size || size->first == 0 || size->second == 0 || size->first > kLongestSide || size->second > kLongestSide) {
    throw UsageError("--size {}: expected WxH with sides from 1 to {} pixels, such as 512x512", text, kLongestSide);
  }
  return *size;
}

visibility::MethodOptions parse_method_options(const std::vector<std::string>& texts) {
  visibility::MethodOptions options;
  for (const std::string& text : texts) insert_option(options, text);
  return options;
}

NamedMethod parse_method(std::string_view text, const std::vector<std::string>& more) {
  const auto fields = split(text, ':');
  NamedMethod method{std::string(fields[0]), parse_method_options(more)};
  for (std::size_t i = 1; i < fields.size(); ++i) insert_option(method.options, fields[i]);
  return method;
}

std::vector<MethodEntry> parse_methods(std::string_view text) {
  std::vector<MethodEntry> entries;
  std::set<std::string> labels;
  const auto add = [&](std::string_view label, std::string_view name, visibility::MethodOptions options,
                       bool from_group) {
    MethodEntry entry{file_name_of(label), std::string(name), std::move(options), from_group};
    for (int number = 2; !labels.insert(entry.label).second; ++number) {
      entry.label = fmt::format("{}-{}", file_name_of(label), number);
    }
    entries.push_back(std::move(entry));
  };
  // Adds the exact area, unless the method computes nothing else, or the group's options exclude it.
  const auto add_exact_area = [&](const visibility::MethodDescription& method, const visibility::MethodOptions& given) {
    visibility::MethodOptions options = given;
    options.insert(method.exact_area->options.begin(), method.exact_area->options.end());
    if (options == given) return;
    std::string label = method.name;
    for (const auto& [key, value] : method.exact_area->options) label += fmt::format(":{}={}", key, value);
    try {
      if (!describe_method(method.name, options).gives_area()) return;
    } catch (const UsageError&) {
      return;
    }
    add(label, method.name, std::move(options), true);
    entries.back().exact_area = true;
  };
  for (const std::string_view part : split(text, ',')) {
    const auto fields = split(part, ':');
    visibility::MethodOptions options;
    for (std::size_t i = 1; i < fields.size(); ++i) insert_option(options, fields[i]);
    if (const auto group = method_group(fields[0])) {
      if (group->empty()) throw UsageError("--methods {}: this build has no {} method", text, fields[0]);
      for (const visibility::MethodDescription* description : *group) {
        describe_method(description->name, options);  // throws for unknown options
        add(description->name, description->name, options, true);
        entries.back().by_default = fields[0] == "default";
        if (description->exact_area) add_exact_area(*description, options);
      }
    } else {
      describe_method(fields[0], options);  // throws for an unknown name, and for invalid options
      add(part, fields[0], std::move(options), false);
    }
  }
  return entries;
}

}  // namespace penumbra::session
