// SPDX-License-Identifier: Apache-2.0
#include "session/machine.hpp"

#include <cstdlib>
#include <string_view>

namespace penumbra::session {

render::Machine make_machine(const std::string& wanted) {
  const char* validation = std::getenv("PENUMBRA_VALIDATION");
  return render::Machine({wanted, validation != nullptr && std::string_view(validation) == "1"});
}

}  // namespace penumbra::session
