// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::volumes {

/// Makes `edge-scatter` on the processor's own vector units (edge-scatter with engine=native): the same algorithm, and
/// the same bits, since every bit is the truth of its pair. Any number of light rows and columns. With `exact_rows`
/// computes the visible fraction of the light, without light samples. docs/edge-scatter.md.
std::unique_ptr<visibility::Method> make_edge_scatter_on_vectors(visibility::MethodDescription description,
                                                                 bool exact_rows);

}  // namespace penumbra::volumes
