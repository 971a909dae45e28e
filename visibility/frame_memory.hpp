// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"
#include "visibility/view_samples.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace penumbra::visibility {

/// V of one light at the view samples of a picture.
struct KeptPicture {
  ViewSamples samples;
  std::vector<float> visibility;  ///< NaN where it is unknown
};

/// Pictures of a sequence that methods keep for its next picture. The host calls next_frame() before each picture;
/// running a method again on the same picture changes nothing.
struct FrameMemory {
  using Key = std::pair<std::int32_t, std::uint32_t>;  ///< Light::index and Light::piece
  std::map<Key, KeptPicture> before, now;
  std::uint32_t frame = 0;  ///< number of pictures before this one

  void next_frame() {
    if (!now.empty()) ++frame;
    before = std::exchange(now, {});
  }
};

/// A method whose V may depend on earlier pictures of a sequence.
class RemembersFrames {
 public:
  /// Gives the sequence's earlier pictures, and the place for the next ones; `memory` must outlive its use. Null: V
  /// depends on the current picture alone, as in a method that was never given any. To be called before prepare_light.
  virtual void remember(FrameMemory* memory) = 0;

 protected:
  ~RemembersFrames() = default;
};

/// Gives the memory to a method that takes one; does nothing for others.
inline void remember(Method& method, FrameMemory* memory) {
  if (auto* const remembers = dynamic_cast<RemembersFrames*>(&method)) remembers->remember(memory);
}

}  // namespace penumbra::visibility
