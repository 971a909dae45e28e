// SPDX-License-Identifier: Apache-2.0
// Compacts selected lanes of a vector. Inside engines/vectors/ only, and in the stages of methods.

#if defined(PENUMBRA_VECTORS_PACK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VECTORS_PACK_INL_HPP
#undef PENUMBRA_VECTORS_PACK_INL_HPP
#else
#define PENUMBRA_VECTORS_PACK_INL_HPP
#endif

#include "engines/vectors/chosen_lanes.hpp"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

/// Returns the selected lanes, compacted. Highway 1.0.3 has tables for this in its own functions, where g++ copies them
/// to the stack at each call, which costs more than the rest of the code.
template <class Tag>
[[maybe_unused]] HWY_INLINE hwy::HWY_NAMESPACE::Vec<Tag> packed(hwy::HWY_NAMESPACE::Vec<Tag> values,
                                                                hwy::HWY_NAMESPACE::Mask<Tag> kept,
                                                                [[maybe_unused]] Tag tag) {
  namespace hn = hwy::HWY_NAMESPACE;
  using Lane = hwy::HWY_NAMESPACE::TFromD<Tag>;
  [[maybe_unused]] constexpr std::size_t kBytes = sizeof(Lane) * hn::MaxLanes(Tag());
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  if constexpr (kBytes == 64 && sizeof(Lane) == 8) {
    const hn::RebindToUnsigned<Tag> bits;
    return hn::BitCast(
        tag, hn::VFromD<decltype(bits)>{_mm512_maskz_compress_epi64(kept.raw, hn::BitCast(bits, values).raw)});
  }
#elif HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4
  [[maybe_unused]] std::uint8_t bits[8] = {};  // size that Highway requires
  if constexpr (sizeof(Lane) >= 4) hn::StoreMaskBits(tag, kept, bits);
  [[maybe_unused]] const std::size_t which = bits[0];
  if constexpr (kBytes == 16 && sizeof(Lane) >= 4) {
    const std::uint8_t* const order = sizeof(Lane) == 4 ? kBytesOfFour[which].data() : kBytesOfTwo[which].data();
    const hn::Repartition<std::uint8_t, Tag> bytes;
    return hn::BitCast(tag, hn::TableLookupBytes(hn::BitCast(bytes, values), hn::LoadU(bytes, order)));
  }
#if HWY_TARGET == HWY_AVX2
  if constexpr (kBytes == 32 && sizeof(Lane) >= 4) {
    const std::uint8_t* const order = sizeof(Lane) == 4 ? kWordsOfEight[which].data() : kWordsOfFour[which].data();
    const hn::CappedTag<std::uint32_t, 8> words;
    const auto lanes = hn::PromoteTo(words, hn::LoadU(hn::CappedTag<std::uint8_t, 8>(), order));
    return hn::BitCast(tag, hn::TableLookupLanes(hn::BitCast(words, values), hn::IndicesFromVec(words, lanes)));
  }
#endif
#endif
  return hn::Compress(values, kept);
}

/// Writes the selected lanes to `to`, which needs space for a whole vector, and returns their number. (Does not use
/// Highway's CompressStore, an instruction that takes more than a hundred cycles on AMD's Zen 4.)
template <class Tag>
[[maybe_unused]] HWY_INLINE std::size_t pack(hwy::HWY_NAMESPACE::Vec<Tag> values, hwy::HWY_NAMESPACE::Mask<Tag> kept,
                                             Tag tag, hwy::HWY_NAMESPACE::TFromD<Tag>* to) {
  namespace hn = hwy::HWY_NAMESPACE;
  hn::StoreU(packed(values, kept, tag), tag, to);
  return hn::CountTrue(tag, kept);
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
