// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method.hpp"

#include <memory>

/// Methods of domes that use the camera's picture alone. Run on the processor.
namespace penumbra::maps {

/// Makes `ssao` (Mittring 2007): points in a ball around the view sample, compared with the picture's depths.
/// docs/ssao.md.
std::unique_ptr<visibility::Method> make_ssao(const visibility::MethodOptions& options);

/// Makes `hbao` (Bavoil, Sainz, Dimitrov 2008): horizons along directions of the picture. docs/hbao.md.
std::unique_ptr<visibility::Method> make_hbao(const visibility::MethodOptions& options);

}  // namespace penumbra::maps
