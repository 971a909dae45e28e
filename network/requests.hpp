// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Requirements of a request.
namespace penumbra::network {

/// Returns 128 random bits, as 32 hexadecimal digits. Throws ResourceError if the system has no source of randomness.
std::string make_token();

/// Returns the part of a request's target before the question mark.
std::string_view path_of(std::string_view target);

/// Returns the value of the target's first parameter with this name, %XX and + decoded; nullopt if there is none.
/// Throws UsageError for a value that is not well formed.
std::optional<std::string> parameter_of(std::string_view target, std::string_view name);

/// Returns whether the target has the parameter `token` with this value, in constant time.
bool has_token(std::string_view target, std::string_view token);

/// Returns whether the header `Host` is `name`, with any port (a tunnel may have another). A page elsewhere whose name
/// was pointed to this machine (DNS rebinding) sends its own name.
bool is_host(std::string_view host, std::string_view name);
/// Returns whether the header `Host` names this machine's loopback.
bool is_loopback_host(std::string_view host);

/// Returns whether the header `Origin` is that of a page from `host`. Programs that are not browsers send no such
/// header: an empty origin is accepted.
bool is_own_origin(std::string_view origin, std::string_view host);

}  // namespace penumbra::network
