// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::session {

/// Returns the wall-clock seconds since the start of this process, to a hundredth; since the first call if the system
/// does not provide the start.
double seconds_since_start();

}  // namespace penumbra::session
