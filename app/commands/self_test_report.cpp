// SPDX-License-Identifier: Apache-2.0
// Output of `devices --self-test`: a row for each pass, as text or JSON. A pass for which the device lacks a feature,
// or which needs an OpenGL that does not exist, counts as not run, not as failed.

#include "app/commands/self_test_report.hpp"

#include "base/error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace penumbra::app {
namespace {

using selftest::Check;

const char* verdict_of(const Check& check) {
  if (!check.refused.empty()) return "not run";
  return check.passed() ? "passed" : "FAILED";
}

}  // namespace

SelfTestReport::SelfTestReport(const render::Device& device, std::vector<Check> checks)
    : checks_(std::move(checks)), vulkan_(fmt::format("{}, {}", device.info().name, device.info().driver)) {
  try {
    const auto& context = device.opengl().info();
    opengl_ = fmt::format("{}, {}", context.name, context.driver);
    has_opengl_ = true;
  } catch (const ResourceError& error) {
    opengl_ = error.what();
  }
}

bool SelfTestReport::passed() const {
  return std::ranges::all_of(checks_, [&](const Check& check) {
    return check.passed() || check.lacking || (!has_opengl_ && !check.refused.empty());
  });
}

void SelfTestReport::print_table() const {
  fmt::print("Vulkan: {}\nOpenGL: {}\n\n", vulkan_, opengl_);
  fmt::print("{:<48} {:>10} {:>10} {:>9} {:>9}  {:<8} {}\n", "pass", "compared", "differing", "largest", "allowed",
             "verdict", "against");
  for (const Check& check : checks_) {
    fmt::print("{:<48} {:>10} {:>10} {:>9.2g} {:>9.2g}  {:<8} {}\n", check.pass, check.compared, check.differing,
               check.largest, check.allowed, verdict_of(check), check.against);
    if (!check.refused.empty() && (has_opengl_ || check.lacking)) fmt::print("    {}\n", check.refused);
    if (check.wrong > 0) {
      fmt::print("    {} of {} break the rule \"{}\"; the first: {}\n", check.wrong, check.compared, check.rule,
                 check.first);
    }
  }
  if (!has_opengl_) fmt::print("\nOpenGL was left out: see above.\n");
}

void SelfTestReport::print_json() const {
  auto rows = nlohmann::ordered_json::array();
  for (const Check& check : checks_) {
    rows.push_back({{"pass", check.pass},
                    {"against", check.against},
                    {"rule", check.rule},
                    {"compared", check.compared},
                    {"differing", check.differing},
                    {"wrong", check.wrong},
                    {"largest", check.largest},
                    {"allowed", check.allowed},
                    {"verdict", verdict_of(check)},
                    {"first", check.first},
                    {"refused", check.refused}});
  }
  const nlohmann::ordered_json report{
      {"vulkan", vulkan_}, {"opengl", opengl_}, {"passed", passed()}, {"checks", std::move(rows)}};
  fmt::print("{}\n", report.dump(2));
}

}  // namespace penumbra::app
