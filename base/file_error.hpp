// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"

#include <cerrno>
#include <string>
#include <system_error>

namespace penumbra {

/// Throws the error for a file that the system did not open or read; `error` is errno, `shown` the file's name and
/// other text that precedes the system's reason. Running out of descriptors or memory, or a failing device, affects
/// every file: these are ResourceErrors, all others InputErrors.
[[noreturn]] inline void throw_file_error(int error, const std::string& shown) {
  const std::string reason = std::generic_category().message(error);
  if (error == EMFILE || error == ENFILE || error == ENOMEM || error == EIO)
    throw ResourceError("{}: {}", shown, reason);
  throw InputError("{}: {}", shown, reason);
}

}  // namespace penumbra
