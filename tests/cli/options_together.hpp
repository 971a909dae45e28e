// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/cli/covering_array.hpp"
#include "tests/cli/program.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace penumbra::tests {

/// A scene of a few triangles and at least two lights, and what it requires of a method.
struct LitScene {
  std::string name, file;
  std::vector<std::string> lights;  ///< kinds, in order
  bool texture = false;
};

/// Writes NAME.json for each scene with which options are tried; `many`: more of them.
std::vector<LitScene> write_lit_scenes(const std::filesystem::path& folder, bool many);

/// Table of `penumbra methods --json`, with the queries that a command line needs.
class MethodTable {
 public:
  explicit MethodTable(nlohmann::json methods) : methods_(std::move(methods)) {}

  [[nodiscard]] const nlohmann::json& all() const { return methods_; }
  [[nodiscard]] bool can_do(const nlohmann::json& method, const LitScene& scene, const std::string& pattern) const;

 private:
  nlohmann::json methods_;
};

/// Named choices: a row of a covering array.
class Row {
 public:
  Row(const std::vector<Factor>& factors, const Choices& choices);
  /// Returns an empty string if nothing is chosen.
  [[nodiscard]] const std::string& operator[](const std::string& factor) const;
  [[nodiscard]] bool has(const std::string& factor) const { return values_.contains(factor); }

 private:
  std::map<std::string, std::string> values_;
};

/// Returns the values to try for an option of a method, from its description; "" stands for an option that is not
/// given. With `default_by_name` the default is also given explicitly.
std::vector<std::string> values_to_try(const nlohmann::json& option, bool default_by_name);

/// Returns whether these options of a method exclude one another or the other choices, according to the method's page.
bool options_exclude(const std::string& method, const std::map<std::string, std::string>& options,
                     const LitScene& scene, const Row& row);

/// Returns the options chosen for the method; factors are named METHOD.OPTION.
std::map<std::string, std::string> options_of(const Row& row, const nlohmann::json& method);

/// Checks a picture that a run has written. Adds failures to the current test.
void expect_whole_picture(const std::string& path, bool all_pixels);
void expect_whole_png(const std::string& path);
void expect_whole_bits(const std::string& path);
void expect_sane_stats(const nlohmann::json& stats);
void expect_sane_metrics(const nlohmann::json& metrics);

}  // namespace penumbra::tests
