// One struct, two languages: accumulate.comp's.
#include "maps/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// The maps of light samples first_sample … first_sample + sample_count - 1; all of them bits of one mask word.
struct AccumulatePush {
  LookupPush lookup;
  uint words_per_mask;
  uint first_sample;
  uint sample_count;
  uint faces;                 // of one light sample
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
