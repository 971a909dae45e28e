// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace penumbra {

/// Throws ResourceError unless this process could have `count` more threads right now. Starts that many threads, all
/// alive at once, and ends them: limits on processes count all processes of a user, so no file has the number.
/// Libraries that cannot start their threads wait forever (a Vulkan driver) or end the process. `what` begins the
/// message: "the device NAME".
void require_threads(unsigned count, std::string_view what);

}  // namespace penumbra
