#pragma once

#include "app/session.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::app {

/// Which object, and which material, each view sample shows.
struct Surfaces {
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  std::vector<std::string> objects, materials;  ///< names
  std::vector<std::uint32_t> object, material;  ///< of each view sample, an index into these, or kNothing
};

Surfaces surfaces_of(const Session& session);

}  // namespace penumbra::app
