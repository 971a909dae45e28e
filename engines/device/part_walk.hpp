#pragma once

#include "base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace penumbra::device {

/// Some processors' drivers end loops after 65,535 turns of a workgroup. Where that is too few, hierarchies are walked
/// in parts, one dispatch after the other: below one child of the root after the other, or of those, and so on.
class PartWalk {
 public:
  void reset() { levels_ = 0; }
  [[nodiscard]] std::uint32_t levels() const { return levels_; }
  /// A part's number is three bits a level, from the lowest.
  [[nodiscard]] std::uint32_t parts() const { return 1U << (3 * levels_); }

  /// After a walk that was cut off. Throws ResourceError where what is left of the deepest walk is one leaf.
  struct Cut {
    const std::string& method;
    const std::string& device;
    std::size_t triangles;
    std::uint32_t depth;  ///< of the deepest hierarchy
  };
  void go_deeper(const Cut& cut) {
    if (levels_ >= cut.depth) {
      throw ResourceError("{}: {} cuts off loops that a hierarchy over {} triangles needs", cut.method, cut.device,
                          cut.triangles);
    }
    ++levels_;
  }

 private:
  std::uint32_t levels_ = 0;
};

}  // namespace penumbra::device
