#pragma once

#include "base/error.hpp"

#include <exception>
#include <string>

namespace penumbra::app {

/// Why something ended early: what the user is told, and the exit code that goes with it.
struct Failure {
  ExitCode code = ExitCode::resource;
  std::string message;
};

/// An exception out of a shadow method that a program using the library added. It goes through to that program.
struct ThrownByCaller {
  std::exception_ptr thrown;
};

/// The exception that is being handled, whatever it is. Only inside of a catch block.
Failure describe_current_exception();

/// The exception that is being handled, as a failure; an interruption, a device that does not answer, and
/// ThrownByCaller are thrown on. Only inside of a catch block.
Failure current_failure();

}  // namespace penumbra::app
