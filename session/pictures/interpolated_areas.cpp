// SPDX-License-Identifier: Apache-2.0
// Interpolates areas at several view samples a pixel from one sample a pixel, where second differences bound the error
// (docs/pictures.md). Not from a paper.

#include "session/pictures/interpolated_areas.hpp"

#include "base/assert.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

namespace penumbra::session {
namespace {

using visibility::Tile;
using visibility::ViewSamples;

/// Below this V the unoccluded light is not estimated from the arriving light.
constexpr float kLeastShare = 1.0f / 64;
/// Neighbours on one smooth surface: the angle of their normals has at least this cosine (23°), and neither is farther
/// from the other's plane than this fraction of their distance, as on an arc of this angle.
constexpr float kLeastCosine = 0.92f, kMostRise = 0.2f;

/// Surfaces at least this many pixels apart cast wide penumbrae on one another.
constexpr float kApart = 16;

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

}  // namespace

InterpolatedAreas::InterpolatedAreas(visibility::Method& method, const visibility::SceneFloats& scene,
                                     std::uint32_t side, double tolerance)
    : AskedAreas(method), scene_(scene), side_(side), tolerance_(tolerance) {
  PENUMBRA_ASSERT(side >= 2 && tolerance > 0, "{} a side, tolerance {}", side, tolerance);
}

void InterpolatedAreas::prepare_light(const visibility::Light& light) {
  AskedAreas::prepare_light(light);
  has_corners_ = false;
}

void InterpolatedAreas::prepare_view(const ViewSamples& samples) {
  AskedAreas::prepare_view(samples);
  fine_ = &samples;
  width_ = samples.width / side_;
  height_ = samples.height / side_;
  PENUMBRA_ASSERT(width_ * side_ == samples.width && height_ * side_ == samples.height, "{}x{} in pixels of {}",
                  samples.width, samples.height, side_);
  has_corners_ = false;
}

std::uint32_t InterpolatedAreas::max_tile_rows() const {
  constexpr std::uint32_t kMostSamples = 1u << 18;  // their answers, 32 bytes each, fit the processor's caches
  return std::max(std::min(AskedAreas::max_tile_rows(), kMostSamples / fine_->width) / side_, 1u) * side_;
}

/// Returns the view sample in the middle of a pixel, or to the lower right of its middle.
std::size_t InterpolatedAreas::corner_of(std::uint32_t x, std::uint32_t y) const {
  return (std::size_t{y} * side_ + side_ / 2) * fine_->width + std::size_t{x} * side_ + side_ / 2;
}

bool InterpolatedAreas::on_one_surface(std::size_t one, std::size_t other) const {
  const std::int32_t carrier = fine_->triangle[one], neighbour = fine_->triangle[other];
  if (carrier == neighbour) return carrier != ViewSamples::kBackground;
  if (carrier == ViewSamples::kBackground || neighbour == ViewSamples::kBackground) return false;
  const auto a = static_cast<std::size_t>(carrier), b = static_cast<std::size_t>(neighbour);
  if (scene_.object[a] != scene_.object[b]) return false;
  if (scene_.plane[a] == scene_.plane[b] && fine_->facing[one] == fine_->facing[other]) return true;
  if (glm::dot(fine_->n[one], fine_->n[other]) < kLeastCosine) return false;
  const glm::vec3 step = fine_->p[other] - fine_->p[one];
  const float rise = kMostRise * glm::length(step);
  return std::abs(glm::dot(fine_->n[one], step)) <= rise && std::abs(glm::dot(fine_->n[other], step)) <= rise;
}

void InterpolatedAreas::look_at_corners() {
  ViewSamples samples;
  samples.width = width_;
  samples.height = height_;
  samples.camera = fine_->camera;
  samples.eye = fine_->eye;
  for (std::uint32_t y = 0; y < height_; ++y) {
    for (std::uint32_t x = 0; x < width_; ++x) {
      const std::size_t from = corner_of(x, y);
      samples.triangle.push_back(fine_->triangle[from]);
      samples.p.push_back(fine_->p[from]);
      samples.n.push_back(fine_->n[from]);
      samples.depth.push_back(fine_->depth[from]);
      samples.facing.push_back(fine_->facing[from]);
    }
  }
  corners_ = ask(samples);
  find_cells();
  has_corners_ = true;
}

/// Returns the second difference at a corner, as an error of V: that of V, or that of the arriving light divided by the
/// unoccluded light, whichever is larger.
float InterpolatedAreas::bend(std::size_t before, std::size_t at, std::size_t after, std::uint32_t step) const {
  const auto x = static_cast<std::uint32_t>(at % width_), y = static_cast<std::uint32_t>(at / width_);
  const std::size_t here = corner_of(x, y);
  if (!on_one_surface(here - step, here) || !on_one_surface(here, here + step))
    return std::numeric_limits<float>::quiet_NaN();
  const AreaAnswer &a = corners_[before], &b = corners_[at], &c = corners_[after];
  double most = std::abs(double{a.visibility} - 2 * double{b.visibility} + double{c.visibility});
  double whole = 0;
  for (const AreaAnswer* answer : {&a, &b, &c}) {
    if (answer->visibility >= kLeastShare)
      whole = std::max(whole, largest(answer->form_factor) / double{answer->visibility});
  }
  if (whole > 0) most = std::max(most, largest(glm::abs(a.form_factor - 2.0 * b.form_factor + c.form_factor)) / whole);
  return static_cast<float>(most);
}

void InterpolatedAreas::find_cells() {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  bends_.resize(corners_.size());
  const auto down = static_cast<std::uint32_t>(side_ * fine_->width);
  tbb::parallel_for(std::uint32_t{0}, height_, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < width_; ++x) {
      const std::size_t at = std::size_t{y} * width_ + x;
      bends_[at].x = x > 0 && x + 1 < width_ ? bend(at - 1, at, at + 1, side_) : kUnknown;
      bends_[at].y = y > 0 && y + 1 < height_ ? bend(at - width_, at, at + width_, down) : kUnknown;
    }
  });
  cells_.resize(std::size_t{width_ - 1} * (height_ - 1));
  tbb::parallel_for(std::uint32_t{0}, height_ - 1, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x + 1 < width_; ++x) cells_[std::size_t{y} * (width_ - 1) + x] = cell_of(x, y);
  });
}

/// Returns whether each surface in the cell that begins at this view sample is far from the others, measured by the
/// size of a pixel there.
bool InterpolatedAreas::are_apart(std::size_t first) const {
  std::vector<std::size_t> shown;  // background is far from every surface
  for (std::uint32_t y = 0; y <= side_; ++y) {
    for (std::uint32_t x = 0; x <= side_; ++x) {
      const std::size_t at = first + std::size_t{y} * fine_->width + x;
      if (fine_->triangle[at] != ViewSamples::kBackground) shown.push_back(at);
    }
  }
  float same = std::numeric_limits<float>::infinity(), other = same;  // shortest distances: on one surface, on two
  for (std::size_t i = 0; i < shown.size(); ++i) {
    for (std::size_t j = i + 1; j < shown.size(); ++j) {
      float& shortest = on_one_surface(shown[i], shown[j]) ? same : other;
      shortest = std::min(shortest, glm::distance(fine_->p[shown[i]], fine_->p[shown[j]]));
    }
  }
  return other > kApart * same * static_cast<float>(side_);
}

InterpolatedAreas::Cell InterpolatedAreas::cell_of(std::uint32_t column, std::uint32_t row) const {
  const std::size_t first = corner_of(column, row);
  for (std::uint32_t y = 0; y <= side_; ++y) {
    for (std::uint32_t x = 0; x <= side_; ++x) {
      if (!on_one_surface(first, first + std::size_t{y} * fine_->width + x))
        return are_apart(first) ? Cell::apart : Cell::touching;
    }
  }
  const std::size_t at = std::size_t{row} * width_ + column;
  float along_x = -1, along_y = -1;  // unknown
  for (const std::size_t corner : {at, at + 1, at + width_, at + width_ + 1}) {
    along_x = std::fmax(along_x, bends_[corner].x);
    along_y = std::fmax(along_y, bends_[corner].y);
  }
  const bool is_known = along_x >= 0 && along_y >= 0;
  return is_known && double{along_x} + double{along_y} <= 8 * tolerance_ ? Cell::smooth : Cell::bent;
}

std::optional<InterpolatedAreas::Slope> InterpolatedAreas::slope(std::uint32_t x, std::uint32_t y) const {
  const std::size_t at = std::size_t{y} * width_ + x;
  struct Along {
    std::size_t from, to;  // indices of corners
    float bend;
  };
  // The slope between the neighbours on both sides if both are on the surface; else the slope to one neighbour, if it
  // and the next corner beyond it are on the surface.
  const auto along = [&](std::size_t step, bool has_before, bool has_after, float Bend::*bend) -> std::optional<Along> {
    if (const float here = bends_[at].*bend; here >= 0) return Along{at - step, at + step, here};
    if (has_before && bends_[at - step].*bend >= 0) return Along{at - step, at, bends_[at - step].*bend};
    if (has_after && bends_[at + step].*bend >= 0) return Along{at, at + step, bends_[at + step].*bend};
    return std::nullopt;
  };
  const auto across = along(1, x > 0, x + 1 < width_, &Bend::x);
  if (!across) return std::nullopt;
  const auto down = along(width_, y > 0, y + 1 < height_, &Bend::y);
  if (!down) return std::nullopt;
  const auto difference = [&](const Along& to, std::size_t step, auto value) {
    const double pixels = to.to - to.from == step ? 1 : 2;
    return (value(corners_[to.to]) - value(corners_[to.from])) / pixels;
  };
  const auto share = [](const AreaAnswer& answer) { return double{answer.visibility}; };
  const auto factor = [](const AreaAnswer& answer) { return answer.form_factor; };
  return Slope{share(corners_[at]),      difference(*across, 1, share),  difference(*down, width_, share),
               factor(corners_[at]),     difference(*across, 1, factor), difference(*down, width_, factor),
               across->bend + down->bend};
}

std::optional<AreaAnswer> InterpolatedAreas::from_corner(std::uint32_t x, std::uint32_t y) const {
  const std::size_t at = std::size_t{y} * fine_->width + x;
  const std::uint32_t half = side_ / 2;  // integer, as in corner_of()
  const auto in_pixels = [&](std::uint32_t place) { return (static_cast<double>(place) - half) / side_; };
  const double right = in_pixels(x), below = in_pixels(y);
  // The corners around the view sample, the nearest first.
  const auto nearest = [](double place) {
    const double first = std::round(place);
    return std::array{first, place < first ? first - 1 : first + 1};
  };
  std::optional<Slope> chosen;
  double chosen_column = 0, chosen_row = 0;
  const auto share_at = [&](double column, double row) {
    return chosen->share + (column - chosen_column) * chosen->share_x + (row - chosen_row) * chosen->share_y;
  };
  for (const double row : nearest(below)) {
    for (const double column : nearest(right)) {
      if (row < 0 || column < 0 || row >= height_ || column >= width_) continue;
      const auto corner_x = static_cast<std::uint32_t>(column), corner_y = static_cast<std::uint32_t>(row);
      if (!on_one_surface(corner_of(corner_x, corner_y), at)) continue;
      if (chosen) {
        const double share = double{corners_[std::size_t{corner_y} * width_ + corner_x].visibility};
        if (std::abs(share_at(column, row) - share) > tolerance_) return std::nullopt;
        continue;
      }
      chosen = slope(corner_x, corner_y);
      if (!chosen || double{chosen->error} > tolerance_) return std::nullopt;
      chosen_column = column;
      chosen_row = row;
    }
  }
  if (!chosen) return std::nullopt;
  const double dx = right - chosen_column, dy = below - chosen_row;
  return AreaAnswer{static_cast<float>(std::clamp(share_at(right, below), 0.0, 1.0)),
                    glm::max(chosen->factor + dx * chosen->factor_x + dy * chosen->factor_y, glm::dvec3(0))};
}

std::vector<std::size_t> InterpolatedAreas::answer(const Tile& tile, std::span<AreaAnswer> answers) {
  if (!has_corners_) look_at_corners();
  const std::uint32_t half = side_ / 2;
  std::vector<std::uint8_t> is_open(answers.size());
  std::atomic<std::uint64_t> interpolated = 0;
  tbb::parallel_for(std::uint32_t{0}, tile.row_count, [&](std::uint32_t i) {
    const std::uint32_t y = tile.first_row + i;
    // Rows and columns of cells, from −1; the border around all corners has no cells.
    const std::int64_t row = (std::int64_t{y} - half + side_) / side_ - 1;
    const double down = static_cast<double>((y + side_ - half) % side_) / side_;
    const bool is_corner_row = (y + side_ - half) % side_ == 0;
    std::uint64_t here = 0;
    std::int64_t column = -1;
    for (std::uint32_t x = 0, step = side_ - half; x < fine_->width; ++x, ++step) {
      if (step == side_) {
        step = 0;
        ++column;
      }
      const std::size_t at = std::size_t{i} * fine_->width + x;
      if (fine_->triangle[std::size_t{y} * fine_->width + x] == ViewSamples::kBackground) continue;
      const double across = static_cast<double>(step) / side_;
      if (step == 0 && is_corner_row) {
        answers[at] = corners_[static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column)];
        continue;
      }
      const bool has_cell =
          row >= 0 && column >= 0 && row + 1 < std::int64_t{height_} && column + 1 < std::int64_t{width_};
      const Cell cell = has_cell
                            ? cells_[static_cast<std::size_t>(row) * (width_ - 1) + static_cast<std::size_t>(column)]
                            : Cell::touching;
      if (cell != Cell::smooth) {
        const std::optional<AreaAnswer> answer = cell == Cell::apart ? from_corner(x, y) : std::nullopt;
        if (answer) {
          answers[at] = *answer;
          ++here;
        } else {
          is_open[at] = 1;
        }
        continue;
      }
      const AreaAnswer* const corner =
          &corners_[static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column)];
      const auto between = [&](auto value) {
        const auto upper = value(corner[0]) + across * (value(corner[1]) - value(corner[0]));
        const auto lower = value(corner[width_]) + across * (value(corner[width_ + 1]) - value(corner[width_]));
        return upper + down * (lower - upper);
      };
      const double share = between([](const AreaAnswer& answer) { return double{answer.visibility}; });
      answers[at] = {static_cast<float>(std::clamp(share, 0.0, 1.0)),
                     between([](const AreaAnswer& answer) { return answer.form_factor; })};
      ++here;
    }
    interpolated += here;
  });
  count("viewSamplesInterpolated", interpolated);
  // Pixels are in Z order; view samples of one pixel follow one another.
  std::vector<std::size_t> open;
  const std::uint32_t rows = (tile.row_count + side_ - 1) / side_;
  std::uint32_t edge = 1;
  while (edge < std::max(rows, width_)) edge *= 2;
  const auto visit = [&](auto&& self, std::uint32_t left, std::uint32_t top, std::uint32_t size) -> void {
    if (left >= width_ || top >= rows) return;
    if (size > 1) {
      const std::uint32_t half_size = size / 2;
      for (const auto& [x, y] : {std::pair{0u, 0u}, {half_size, 0u}, {0u, half_size}, {half_size, half_size}})
        self(self, left + x, top + y, half_size);
      return;
    }
    for (std::uint32_t y = top * side_; y < std::min((top + 1) * side_, tile.row_count); ++y) {
      for (std::uint32_t x = left * side_; x < (left + 1) * side_; ++x) {
        const std::size_t at = std::size_t{y} * fine_->width + x;
        if (is_open[at] != 0) open.push_back(at);
      }
    }
  };
  visit(visit, 0, 0, edge);
  return open;
}

std::uint64_t InterpolatedAreas::memory_bytes() const {
  return AskedAreas::memory_bytes() + corners_.capacity() * sizeof(AreaAnswer) + cells_.capacity() +
         bends_.capacity() * sizeof(Bend);
}

}  // namespace penumbra::session
