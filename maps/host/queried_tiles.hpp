// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/face_fit.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Draws maps of these faces and returns V of every pixel.
using PictureOf = std::function<std::vector<float>(const std::vector<FittedFace>&)>;

struct QueriedTiles {
  std::vector<FittedFace> faces;
  std::uint32_t pictures = 0;  ///< pictures that were compared
};

/// M. Giegl, M. Wimmer, Queried virtual shadow maps, I3D 2007: cuts faces in four, then again each square in which a
/// cut changed more than fit.changed pixels, the most changed first, as long as there are no more than fit.tiles faces.
/// `receivers`: the receiver at each pixel, if any.
QueriedTiles queried_tiles(const std::vector<FittedFace>& whole, std::span<const std::optional<SeenReceiver>> receivers,
                           const ViewFit& fit, const PictureOf& picture_of);

}  // namespace penumbra::maps
