// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"

#include <exception>
#include <string>

namespace penumbra::session {

/// Reason of an early end: the message to the user, and its exit code.
struct Failure {
  ExitCode code = ExitCode::resource;
  std::string message;
};

/// Exception from a shadow method added by a program that uses the library. Passed through to this program.
struct ThrownByCaller {
  std::exception_ptr thrown;
};

/// Returns the current exception, of any type, as a failure. Callable only inside a catch block.
Failure describe_current_exception();

/// Returns the current exception as a failure; rethrows an interruption, a device that does not answer, and
/// ThrownByCaller. Callable only inside a catch block.
Failure current_failure();

}  // namespace penumbra::session
