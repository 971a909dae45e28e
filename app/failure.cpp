#include "app/failure.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>

namespace penumbra::app {

Failure current_failure() {
  try {
    throw;
  } catch (const Error& error) {
    if (error.code() == ExitCode::interrupted) throw;
    return {error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::resource, "out of memory; choose a smaller --size, fewer --light-samples or a smaller scene"};
  } catch (const std::exception& error) {
    return {ExitCode::resource, fmt::format("unexpected: {}", error.what())};
  }
}

}  // namespace penumbra::app
