#pragma once

#include "base/error.hpp"

#include <string>

namespace penumbra::app {

/// Why something ended early: what the user is told, and the exit code that goes with it.
struct Failure {
  ExitCode code = ExitCode::resource;
  std::string message;
};

/// The exception that is being handled, whatever it is. Only inside of a catch block.
Failure describe_current_exception();

/// The exception that is being handled, as a failure; an interruption, and a device that
/// does not answer, are thrown on. Only inside of a catch block.
Failure current_failure();

}  // namespace penumbra::app
