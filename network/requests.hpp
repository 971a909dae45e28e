#pragma once

#include <string>
#include <string_view>

/// What a request must have to be answered.
namespace penumbra::network {

/// 128 bits that nobody can guess, as 32 hexadecimal digits. Throws ResourceError where the system has none.
std::string make_token();

/// The part of a request's target before the question mark.
std::string_view path_of(std::string_view target);

/// Has the target the parameter `token` with this value? Takes as long whichever digit is wrong.
bool has_token(std::string_view target, std::string_view token);

/// Does the header `Host` name this machine's loopback, with any port (a tunnel may have another)? A page elsewhere
/// whose name has been pointed to this machine sends its own name.
bool is_loopback_host(std::string_view host);

/// Is the header `Origin` that of a page from `host`? Programs that are no browsers send none, which is empty.
bool is_own_origin(std::string_view origin, std::string_view host);

}  // namespace penumbra::network
