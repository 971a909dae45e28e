#pragma once

#include <string_view>

namespace penumbra {

/// Throws ResourceError unless this process could have `count` more threads right now. They are started, all there at
/// once, and ended: limits on processes count all that a user has, so no number in a file tells. Libraries that cannot
/// start theirs wait for ever (a Vulkan driver), or end the process. `what` begins the message: "the device NAME".
void require_threads(unsigned count, std::string_view what);

}  // namespace penumbra
