#pragma once

#include "base/error.hpp"

#include <cerrno>
#include <string>
#include <system_error>

namespace penumbra {

/// For a file that the system did not open or read; `error` is errno, `shown` the file's name and what else is to stand
/// before the system's reason. Of descriptors and memory the process or the machine has run out, and of a device that
/// fails no other file is to be had: that is a ResourceError, all else an InputError.
[[noreturn]] inline void throw_file_error(int error, const std::string& shown) {
  const std::string reason = std::generic_category().message(error);
  if (error == EMFILE || error == ENFILE || error == ENOMEM || error == EIO)
    throw ResourceError("{}: {}", shown, reason);
  throw InputError("{}: {}", shown, reason);
}

}  // namespace penumbra
