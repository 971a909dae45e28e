// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace penumbra::device {

/// Some drivers for processors end loops after 65,535 iterations of a workgroup. Where that is too few, hierarchies are
/// traversed in parts, one dispatch after the other: one part for each child of the root, or each grandchild, and so
/// on.
class PartWalk {
 public:
  void reset() { levels_ = 0; }
  [[nodiscard]] std::uint32_t levels() const { return levels_; }
  /// Returns the number of parts; a part's number has three bits for each level, from the lowest.
  [[nodiscard]] std::uint32_t parts() const { return 1U << (3 * levels_); }

  /// A traversal that was cut off, for the error message. go_deeper() throws ResourceError if parts are already as
  /// small as single leaves.
  struct Cut {
    const std::string& method;
    const std::string& device;
    std::size_t triangles;
    std::uint32_t depth;  ///< depth of the deepest hierarchy
  };
  void go_deeper(const Cut& cut) {
    if (levels_ >= cut.depth) {
      throw ResourceError("{}: {} ends loops too early for a hierarchy over {} triangles", cut.method, cut.device,
                          cut.triangles);
    }
    ++levels_;
  }

 private:
  std::uint32_t levels_ = 0;
};

}  // namespace penumbra::device
