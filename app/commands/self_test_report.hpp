// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "selftest/check.hpp"

#include <string>
#include <vector>

namespace penumbra::app {

/// Results of `devices --self-test`, as a table and as JSON, on stdout.
class SelfTestReport {
 public:
  SelfTestReport(const render::Device& device, std::vector<selftest::Check> checks);

  /// Returns whether nothing failed. Checks that could not run without OpenGL are not failures; they are reported as
  /// left out.
  [[nodiscard]] bool passed() const;
  void print_table() const;
  void print_json() const;

 private:
  std::vector<selftest::Check> checks_;
  std::string vulkan_, opengl_;  ///< tested devices; for OpenGL possibly the reason why it was not tested
  bool has_opengl_ = false;
};

}  // namespace penumbra::app
