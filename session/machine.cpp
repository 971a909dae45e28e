// SPDX-License-Identifier: Apache-2.0
// Makes the machine of a command; its device is created when a method first needs it.

#include "session/machine.hpp"

#include <cstdlib>
#include <string_view>

namespace penumbra::session {

render::Machine make_machine(const std::string& wanted) {
  const char* validation = std::getenv("PENUMBRA_VALIDATION");
  return render::Machine({wanted, validation != nullptr && std::string_view(validation) == "1"});
}

}  // namespace penumbra::session
