#include "engines/vectors/horizon.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engines/vectors/horizon.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::native::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void cut_at_horizon_here(const Frame& frame, const Placed& at, Open& open, Seen& seen) {
  const hn::CappedTag<float, 16> d;
  const std::size_t words = frame.padded_rows / 16;
  const auto constant = [&](float x) { return hn::Set(d, x); };
  std::uint32_t visible = 0;
  const float per_column = at.above.x / frame.half_cells.x, per_row = at.above.y / frame.half_cells.y;
  for (std::uint32_t first = 0; first < frame.padded_rows; first += static_cast<std::uint32_t>(hn::Lanes(d))) {
    const auto rows =
        hn::Sub(hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(first))), constant(frame.first_cell.y));
    const auto shifts = hn::Sub(hn::LoadU(d, &frame.shift[first]), constant(frame.first_cell.x));
    const auto value_of_row =
        hn::MulAdd(rows, constant(per_row), hn::MulAdd(shifts, constant(per_column), constant(at.above.z)));
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      const auto value = hn::MulAdd(constant(static_cast<float>(column)), constant(per_column), value_of_row);
      std::uint8_t above[8] = {}, not_below[8] = {};
      hn::StoreMaskBits(d, hn::Gt(value, constant(at.above_error)), above);
      hn::StoreMaskBits(d, hn::Ge(value, constant(-at.above_error)), not_below);
      std::uint16_t& word = seen.mask[column * words + first / 16];
      const std::uint32_t lanes = (1U << hn::Lanes(d)) - 1, place = first % 16;
      const std::uint32_t is_above = above[0] | std::uint32_t{above[1]} << 8U,
                          may_be = not_below[0] | std::uint32_t{not_below[1]} << 8U;
      word = static_cast<std::uint16_t>(word & ~((lanes & ~is_above) << place));
      visible += static_cast<std::uint32_t>(std::popcount(word & lanes << place));
      for (std::uint32_t left = may_be & ~is_above & lanes; left != 0; left &= left - 1) {
        const std::uint32_t row = first + static_cast<std::uint32_t>(std::countr_zero(left));
        if (row < frame.rows) open.samples.push_back(row * frame.columns + column);
      }
    }
  }
  seen.visible = visible;
}

}  // namespace
}  // namespace penumbra::native::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::native {

HWY_EXPORT(cut_at_horizon_here);

void cut_at_horizon(const Frame& frame, const Placed& at, Open& open, Seen& seen) {
  HWY_DYNAMIC_DISPATCH(cut_at_horizon_here)(frame, at, open, seen);
}

void fill(const Frame& frame, bool visible, Seen& seen) {
  const std::size_t words = frame.padded_rows / 16;
  for (std::size_t i = 0; i < frame.columns * words; ++i) {
    const std::size_t first = i % words * 16,
                      rows = std::min<std::size_t>(frame.rows - std::min<std::size_t>(first, frame.rows), 16);
    seen.mask[i] = visible ? static_cast<std::uint16_t>((1U << rows) - 1) : std::uint16_t{0};
  }
  seen.visible = visible ? frame.rows * frame.columns : 0;
}

void see_all(const Frame& frame, const Placed& at, Open& open, Judge& judge, Seen& seen) {
  seen.visible = frame.rows * frame.columns;
  if (!at.straddles && !open.any()) return;
  fill(frame, true, seen);
  if (at.straddles) cut_at_horizon(frame, at, open, seen);
  if (open.any()) judge.decide(at, open, seen);
}

}  // namespace penumbra::native
#endif
