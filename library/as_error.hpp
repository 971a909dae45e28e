#pragma once

#include "app/process/failure.hpp"
#include "base/error.hpp"

namespace penumbra {

/// Throws the exception that is being handled: the library's own errors and what functions of the calling program threw
/// as they are, all others (no memory, a library below) as ResourceError with the command line's message. Only inside
/// of a catch block.
[[noreturn]] inline void throw_as_error() {
  try {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const app::ThrownByCaller& caller) {
    std::rethrow_exception(caller.thrown);
  } catch (...) {
    throw ResourceError("{}", app::describe_current_exception().message);
  }
}

/// Returns what `function` returns; its exceptions leave as Error (throw_as_error()).
template <typename Function>
decltype(auto) with_errors(const Function& function) {
  try {
    return function();
  } catch (...) {
    throw_as_error();
  }
}

}  // namespace penumbra
