// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace penumbra::compare {

/// Machine of the measurements. Unknown values are empty or 0.
struct Machine {
  std::string processor;  ///< "Intel(R) Xeon(R) …"
  unsigned threads = 0;   ///< hardware threads available to this process
  std::uint64_t memory_bytes = 0;
  std::string operating_system;  ///< "Debian GNU/Linux 12 (bookworm), Linux 6.1.0 x86_64"
};

Machine this_machine();

}  // namespace penumbra::compare
