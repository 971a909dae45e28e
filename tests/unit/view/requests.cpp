// SPDX-License-Identifier: Apache-2.0
// Tests which requests the page's server answers.
#include "network/requests.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <set>

namespace penumbra::network {
namespace {

TEST(Requests, TokensAreLongAndNoTwoAreAlike) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) {
    const std::string token = make_token();
    EXPECT_EQ(token.size(), 32U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    EXPECT_TRUE(tokens.insert(token).second) << token;
  }
}

TEST(Requests, TheTokenIsAParameterOfItsOwn) {
  EXPECT_TRUE(has_token("/?token=abc", "abc"));
  EXPECT_TRUE(has_token("/live?x=1&token=abc", "abc"));
  EXPECT_TRUE(has_token("/?token=abc&x", "abc"));
  for (const char* target : {"/", "/?", "/?token=", "/?token=ab", "/?token=abcd", "/?token=abd", "/?xtoken=abc",
                             "/?token=abd&token=abc", "/token=abc", "/?&&", "/?token", "token=abc"})
    EXPECT_FALSE(has_token(target, "abc")) << target;
  EXPECT_EQ(path_of("/live?token=abc"), "/live");
  EXPECT_EQ(path_of("/"), "/");
}

TEST(Requests, ParametersAreDecoded) {
  constexpr const char* kTarget = "/space/shadows?light=a+b%20%26%C3%A4&s=-0.5&s=1&token=x&empty=";
  EXPECT_EQ(parameter_of(kTarget, "light"), "a b &\u00e4");
  EXPECT_EQ(parameter_of(kTarget, "s"), "-0.5");  // the first
  EXPECT_EQ(parameter_of(kTarget, "empty"), "");
  for (const char* const none : {"t", "lig", "ight", "light=a+b%20%26%C3%A4", ""})
    EXPECT_EQ(parameter_of(kTarget, none), std::nullopt) << none;
  for (const char* const none : {"/a=1", "/", ""}) EXPECT_EQ(parameter_of(none, "a"), std::nullopt) << none;
  for (const char* const wrong : {"/?a=%", "/?a=%4", "/?a=%4g", "/?a=%zz"})
    EXPECT_THROW(static_cast<void>(parameter_of(wrong, "a")), UsageError) << wrong;
  EXPECT_EQ(parameter_of("/?a=%41", "a"), "A");
}

TEST(Requests, HostsAreTheLoopbacksNames) {
  for (const char* host : {"127.0.0.1", "127.0.0.1:80", "localhost:8080", "[::1]:1", "localhost"})
    EXPECT_TRUE(is_loopback_host(host)) << host;
  for (const char* host : {"", "localhost.evil.example", "127.0.0.1.evil.example:80", "evil.example", "localhost:80x",
                           "127.0.0.2", "localhost:80@evil.example", "0.0.0.0:80"})
    EXPECT_FALSE(is_loopback_host(host)) << host;
}

TEST(Requests, AnotherHostIsTheOneThatIsServedOn) {
  for (const char* host : {"192.168.0.7", "192.168.0.7:80"}) EXPECT_TRUE(is_host(host, "192.168.0.7")) << host;
  EXPECT_TRUE(is_host("[fe80::1]:80", "[fe80::1]"));
  for (const char* host : {"192.168.0.77", "192.168.0.7.evil.example", "192.168.0.7:x", "fe80::1", ""})
    EXPECT_FALSE(is_host(host, "192.168.0.7")) << host;
}

TEST(Requests, OriginsAreThePagesOwnOrMissing) {
  EXPECT_TRUE(is_own_origin("", "localhost:80"));
  EXPECT_TRUE(is_own_origin("http://localhost:80", "localhost:80"));
  for (const char* origin : {"null", "http://localhost", "https://localhost:80", "http://localhost:801",
                             "http://evil.example", "file://", "http://localhost:80.evil.example"})
    EXPECT_FALSE(is_own_origin(origin, "localhost:80")) << origin;
}

}  // namespace
}  // namespace penumbra::network
