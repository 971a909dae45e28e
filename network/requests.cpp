// SPDX-License-Identifier: Apache-2.0
// Checks requests: token, host and origin.

#include "network/requests.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include <sys/random.h>

namespace penumbra::network {
namespace {

/// Returns the value of the first parameter with this name, as it stands in the target.
std::optional<std::string_view> raw_parameter(std::string_view target, std::string_view name) {
  const std::size_t question = target.find('?');
  if (question == std::string_view::npos) return std::nullopt;
  std::string_view rest = target.substr(question + 1);
  while (!rest.empty()) {
    const std::string_view part = rest.substr(0, rest.find('&'));
    rest.remove_prefix(part.size() < rest.size() ? part.size() + 1 : rest.size());
    if (part.starts_with(name) && part.substr(name.size()).starts_with('=')) return part.substr(name.size() + 1);
  }
  return std::nullopt;
}

/// Returns the value of a hexadecimal digit; −1 for any other character.
int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::string make_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw ResourceError("the system gives no random bytes for the address of the page");
  std::string token;
  for (const std::uint8_t byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

std::string_view path_of(std::string_view target) {
  return target.substr(0, target.find('?'));
}

std::optional<std::string> parameter_of(std::string_view target, std::string_view name) {
  const std::optional<std::string_view> text = raw_parameter(target, name);
  if (!text) return std::nullopt;
  std::string value;
  for (std::size_t i = 0; i < text->size(); ++i) {
    const char c = (*text)[i];
    if (c != '%') {
      value += c == '+' ? ' ' : c;
      continue;
    }
    const bool is_whole = i + 2 < text->size();
    const int high = is_whole ? digit_of((*text)[i + 1]) : -1;
    const int low = is_whole ? digit_of((*text)[i + 2]) : -1;
    if (high < 0 || low < 0) throw UsageError("{}={}: expected two hexadecimal digits after %", name, *text);
    value += static_cast<char>(16 * high + low);
    i += 2;
  }
  return value;
}

bool has_token(std::string_view target, std::string_view token) {
  const std::optional<std::string_view> given = raw_parameter(target, "token");
  if (!given || given->size() != token.size()) return false;
  int differing = 0;
  for (std::size_t i = 0; i < token.size(); ++i) differing |= (*given)[i] ^ token[i];
  return differing == 0;
}

bool is_host(std::string_view host, std::string_view name) {
  if (!host.starts_with(name)) return false;
  const std::string_view port = host.substr(name.size());
  if (port.empty()) return true;
  return port.front() == ':' && port.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

bool is_loopback_host(std::string_view host) {
  return is_host(host, "127.0.0.1") || is_host(host, "localhost") || is_host(host, "[::1]");
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  if (origin.empty()) return true;
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host;
}

}  // namespace penumbra::network
