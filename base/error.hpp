// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/error.hpp>

#include <fmt/format.h>

#include <string>
#include <utility>

namespace penumbra {
namespace detail {

/// A format string that is checked against its arguments at compile time, for errors that the library's headers declare
/// without including fmt.
template <typename... Args>
class Format {
 public:
  template <typename Text>
  consteval explicit(false) Format(const Text& text) : text_(text) {}
  [[nodiscard]] fmt::format_string<Args...> text() const { return text_; }

 private:
  fmt::format_string<Args...> text_;
};

}  // namespace detail

template <typename... Args>
requires(sizeof...(Args) > 0) UsageError::UsageError(detail::Format<std::type_identity_t<Args>...> format,
                                                     Args&&... args)
    : UsageError(fmt::format(format.text(), std::forward<Args>(args)...)) {}

template <typename... Args>
requires(sizeof...(Args) > 0) InputError::InputError(detail::Format<std::type_identity_t<Args>...> format,
                                                     Args&&... args)
    : InputError(fmt::format(format.text(), std::forward<Args>(args)...)) {}

template <typename... Args>
requires(sizeof...(Args) > 0) ResourceError::ResourceError(detail::Format<std::type_identity_t<Args>...> format,
                                                           Args&&... args)
    : ResourceError(fmt::format(format.text(), std::forward<Args>(args)...)) {}

}  // namespace penumbra
