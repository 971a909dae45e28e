// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "session/process/failure.hpp"

namespace penumbra {

/// Rethrows the current exception: the library's own errors, and exceptions of the calling program's functions,
/// unchanged; all others (out of memory, errors of other libraries) as ResourceError with the command line's message.
/// Callable only inside a catch block.
[[noreturn]] inline void throw_as_error() {
  try {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const session::ThrownByCaller& caller) {
    std::rethrow_exception(caller.thrown);
  } catch (...) {
    throw ResourceError("{}", session::describe_current_exception().message);
  }
}

/// Returns the result of `function`; its exceptions are converted to Error by throw_as_error().
template <typename Function>
decltype(auto) with_errors(const Function& function) {
  try {
    return function();
  } catch (...) {
    throw_as_error();
  }
}

}  // namespace penumbra
