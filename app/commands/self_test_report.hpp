#pragma once

#include "render/device.hpp"
#include "selftest/check.hpp"

#include <string>
#include <vector>

namespace penumbra::app {

/// What `devices --self-test` found, for people and for programs, on stdout.
class SelfTestReport {
 public:
  SelfTestReport(const render::Device& device, std::vector<selftest::Check> checks);

  /// Nothing failed. What could not run for want of OpenGL is no failure, and is said to have been left out.
  [[nodiscard]] bool passed() const;
  void print_table() const;
  void print_json() const;

 private:
  std::vector<selftest::Check> checks_;
  std::string vulkan_, opengl_;  ///< what was tested; of OpenGL perhaps why not
  bool has_opengl_ = false;
};

}  // namespace penumbra::app
