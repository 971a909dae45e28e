// SPDX-License-Identifier: Apache-2.0
// M. Giegl, M. Wimmer, Queried virtual shadow maps, I3D 2007, as described in the course notes of Eisemann et al. 2009,
// section 3.2.4.1. Departures: pictures are compared on the host, where the paper counts changed pixels by occlusion
// queries; all squares that need a cut are cut before the next picture; if maps run out, the most changed squares are
// cut first.

#include "maps/host/queried_tiles.hpp"

#include "base/assert.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

namespace penumbra::maps {
namespace {

/// Change of V beyond which a pixel counts as changed.
constexpr float kChange = 1.0F / 16;
/// Finest level, with 1024 × 1024 squares. The paper's finest level has 32 × 32, with maps of 2048².
constexpr std::uint32_t kFinest = 10;

struct Square {
  std::size_t whole = 0;  ///< index of the face that the square is a part of
  std::uint32_t level = 0;
  glm::dvec2 first{0};
  std::vector<std::uint32_t> pixels;
  std::size_t changed = std::numeric_limits<std::size_t>::max();  ///< number of pixels changed by the last cut
};

/// Returns the quarters of a square.
std::vector<Square> cut(const Square& square, std::span<const glm::dvec2> places) {
  std::vector<Square> quarters;
  for (const double y : {0.0, 1.0}) {
    for (const double x : {0.0, 1.0}) {
      Square quarter{square.whole, square.level + 1, 2.0 * square.first + glm::dvec2(x, y), {}, 0};
      const double across = std::exp2(quarter.level);
      std::ranges::copy_if(square.pixels, std::back_inserter(quarter.pixels),
                           [&](std::uint32_t pixel) { return glm::floor(places[pixel] * across) == quarter.first; });
      quarters.push_back(std::move(quarter));
    }
  }
  return quarters;
}

}  // namespace

QueriedTiles queried_tiles(const std::vector<FittedFace>& whole, std::span<const std::optional<SeenReceiver>> receivers,
                           const ViewFit& fit, const PictureOf& picture_of) {
  std::vector<Square> squares(whole.size());
  std::vector<glm::dvec2> places(receivers.size());
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i].whole = i;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const FittedFace* face = receivers[i] ? face_for(whole, *receivers[i]) : nullptr;
    if (face == nullptr) continue;
    places[i] = *face->place(receivers[i]->e);
    squares[static_cast<std::size_t>(face - whole.data())].pixels.push_back(static_cast<std::uint32_t>(i));
  }
  QueriedTiles result{whole, 1};
  std::vector<float> before = picture_of(whole);
  while (true) {
    std::ranges::stable_sort(squares, std::greater(), &Square::changed);
    std::vector<Square> kept, quarters;
    for (Square& square : squares) {
      const bool due = square.changed > fit.changed && !square.pixels.empty() && square.level < kFinest;
      if (due && squares.size() + 3 * (quarters.size() / 4 + 1) <= fit.tiles) {
        std::ranges::move(cut(square, places), std::back_inserter(quarters));
      } else {
        kept.push_back(std::move(square));
      }
    }
    if (quarters.empty()) return result;
    result.faces.clear();
    for (const auto* some : {&kept, &quarters}) {
      for (const Square& square : *some) {
        result.faces.push_back(square_of(whole[square.whole], square.level, square.first));
      }
    }
    // Faces of the first side come first.
    std::ranges::stable_sort(result.faces, {}, &FittedFace::side);
    const std::vector<float> now = picture_of(result.faces);
    ++result.pictures;
    PENUMBRA_ASSERT(now.size() == receivers.size(), "a picture of {} pixels for {}", now.size(), receivers.size());
    // A square that was not cut keeps its number of changed pixels, and so its reason to be cut.
    for (Square& square : quarters) {
      square.changed = static_cast<std::size_t>(std::ranges::count_if(
          square.pixels, [&](std::uint32_t pixel) { return std::abs(now[pixel] - before[pixel]) > kChange; }));
    }
    std::ranges::move(quarters, std::back_inserter(kept));
    squares = std::move(kept);
    before = now;
  }
}

}  // namespace penumbra::maps
