// Keeps some of a vector's values, side by side. Inside engines/vectors/ only, and in the stages of methods.

#if defined(PENUMBRA_VECTORS_PACK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VECTORS_PACK_INL_HPP
#undef PENUMBRA_VECTORS_PACK_INL_HPP
#else
#define PENUMBRA_VECTORS_PACK_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

/// Writes the lanes that are kept to `to`, which needs room for a whole vector, and gives their number.
template <class Tag>
[[maybe_unused]] HWY_INLINE std::size_t pack(hwy::HWY_NAMESPACE::Vec<Tag> values, hwy::HWY_NAMESPACE::Mask<Tag> kept,
                                             Tag tag, hwy::HWY_NAMESPACE::TFromD<Tag>* to) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  // Highway's CompressStore is one instruction here, for which AMD's Zen 4 takes more than a hundred cycles.
  hn::StoreU(hn::Compress(values, kept), tag, to);
  return hn::CountTrue(tag, kept);
#else
  return hn::CompressStore(values, kept, tag, to);
#endif
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once a target
