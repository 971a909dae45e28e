// SPDX-License-Identifier: Apache-2.0
// Converts exceptions to messages and exit codes.

#include "session/process/failure.hpp"

#include "base/memory.hpp"
#include "render/device.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

namespace penumbra::session {
namespace {

/// Returns the meaning of a library's exception, as far as it can be determined.
std::string explain(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (std::ferror(stdout) != 0)
    return fmt::format("cannot write to stdout: {}", system != nullptr ? system->code().message() : error.what());
  const bool no_thread = (system != nullptr && system->code() == std::errc::resource_unavailable_try_again) ||
                         std::string_view(error.what()).find("pthread_create") != std::string_view::npos;
  if (no_thread) {
    return fmt::format(
        "cannot start a thread ({}); raise the limit on processes (ulimit -u, the control group's pids.max), or that "
        "on memory (ulimit -v)",
        error.what());
  }
  // No library's exception should arrive here; if one does, it is an internal error with a message, not a crash.
  return fmt::format("internal: {}", error.what());
}

}  // namespace

Failure describe_current_exception() {
  try {
    throw;
  } catch (const Error& error) {
    return {error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    // The amount in use cannot be reported any more: unwinding has released the memory.
    give_back_memory();
    const MemoryRoom room = memory_room();
    return {ExitCode::resource, fmt::format("out of memory ({} is the most that {}, after everything was released); "
                                            "choose a smaller --size, fewer --light-samples or a smaller scene",
                                            in_bytes(room.bytes), room.limit)};
  } catch (const std::exception& error) {
    return {ExitCode::resource, explain(error)};
  }
}

Failure current_failure() {
  try {
    throw;
  } catch (const render::DeviceDoesNotAnswer&) {
    throw;  // rethrown: no further work is possible with this device, and the process must end without destroying it
  } catch (const ThrownByCaller&) {
    throw;
  } catch (const Error& error) {
    if (error.code() == ExitCode::interrupted) throw;
  } catch (...) {
  }
  return describe_current_exception();
}

}  // namespace penumbra::session
