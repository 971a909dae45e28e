// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/pictures/asked_areas.hpp"

namespace penumbra::session {

/// Areas at view samples through a lens. On blurred surfaces the view samples of neighbouring pixels are far apart, so
/// that engines, which share work among neighbours, share little. Therefore the method is given the view samples in an
/// order of their positions in space.
class LensAreas final : public AskedAreas {
 public:
  explicit LensAreas(visibility::Method& method) : AskedAreas(method) {}

 private:
  std::vector<std::size_t> answer(const visibility::Tile& tile, std::span<AreaAnswer> answers) override;
};

}  // namespace penumbra::session
