#include "web_viewer/request_rules.h"

#include <gtest/gtest.h>

namespace rimod {
namespace {

TEST(RequestRulesTest, TheMachineItselfIsAllowedOnAnyPort) {
  for (const char* const host : {"localhost", "localhost:8086", "LocalHost:9", "127.0.0.1",
                                 "127.0.0.1:65535", "[::1]", "[::1]:8086"})
    EXPECT_TRUE(IsAllowedHost(host, {})) << host;
}

TEST(RequestRulesTest, OtherHostsAreNot) {
  for (const char* const host :
       {"", ":8086", "example.org", "example.org:8086", "localhost.example.org", "127.0.0.1.nip.io",
        "localhost:", "localhost:80x", "localhost:123456", "localhost:80:80", "127.0.0.2",
        "[::2]:80", "user@localhost", "evil]:80", " localhost"})
    EXPECT_FALSE(IsAllowedHost(host, {})) << host;
}

TEST(RequestRulesTest, FurtherNamesAreAllowed) {
  EXPECT_TRUE(IsAllowedHost("robot:8086", {"base", "Robot"}));
  EXPECT_FALSE(IsAllowedHost("robots:8086", {"base", "Robot"}));
  EXPECT_FALSE(IsAllowedHost("", {""}));
}

TEST(RequestRulesTest, AnOriginIsTheSameWhenHostAndPortAre) {
  EXPECT_TRUE(IsSameOrigin("http://localhost:8086", "localhost:8086"));
  EXPECT_TRUE(IsSameOrigin("https://robot", "robot:443"));
  EXPECT_TRUE(IsSameOrigin("http://robot:80", "Robot"));
  EXPECT_TRUE(IsSameOrigin("http://[::1]:8086", "[::1]:8086"));
}

TEST(RequestRulesTest, OtherOriginsAreNot) {
  for (const char* const origin :
       {"", "null", "http://", "http://localhost", "http://localhost:3000",
        "http://example.org:8086", "http://127.0.0.1:8086", "file://localhost:8086",
        "localhost:8086", "http://localhost:8086.example.org", "http://localhost:8086/x",
        "https://localhost"})
    EXPECT_FALSE(IsSameOrigin(origin, "localhost:8086")) << origin;
  EXPECT_FALSE(IsSameOrigin("http://", ""));
}

}  // namespace
}  // namespace rimod
