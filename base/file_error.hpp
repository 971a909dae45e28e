#pragma once

#include "base/error.hpp"

#include <cerrno>
#include <string>
#include <system_error>

namespace penumbra {

/// What to throw for a file that the system did not open or read; `error` is errno, `shown` the file's name and what
/// else is to stand before the system's reason. Of descriptors and memory the process or the machine has run out, and
/// of a device that fails no other file is to be had: those are resources (exit code 4); all else is bad input (3).
inline Error file_error(int error, const std::string& shown) {
  const bool machine = error == EMFILE || error == ENFILE || error == ENOMEM || error == EIO;
  return {machine ? ExitCode::resource : ExitCode::input,
          fmt::format("{}: {}", shown, std::generic_category().message(error))};
}

}  // namespace penumbra
