#pragma once

#include "app/pictures/asked_areas.hpp"

namespace penumbra::app {

/// Areas at view samples through a lens. Where surfaces are blurred those of neighbouring pixels are far apart, and
/// engines, which share work among neighbours, share little: the method is asked in an order of places in space.
class LensAreas final : public AskedAreas {
 public:
  explicit LensAreas(visibility::Method& method) : AskedAreas(method) {}

 private:
  std::vector<std::size_t> answer(const visibility::Tile& tile, std::span<AreaAnswer> answers) override;
};

}  // namespace penumbra::app
