#include "web_viewer/client_request.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

namespace rimod {
namespace {

using Kind = ClientRequest::Kind;

TEST(ClientRequestTest, EveryKindIsRead) {
  EXPECT_EQ(ParseClientRequest(R"({"type":"shown"})")->kind, Kind::kShown);
  EXPECT_EQ(ParseClientRequest(R"({"type":"follow"})")->kind, Kind::kFollow);
  EXPECT_EQ(ParseClientRequest(R"({"type":"choose","id":7})")->id, 7);
  EXPECT_EQ(ParseClientRequest(R"({"type":"model","name":"fan"})")->name, "fan");
  EXPECT_EQ(ParseClientRequest(R"({"type":"play"})")->command, PlayerCommand::kPlay);
  EXPECT_EQ(ParseClientRequest(R"({"type":"pause"})")->command, PlayerCommand::kPause);
  EXPECT_EQ(ParseClientRequest(R"({"type":"step"})")->command, PlayerCommand::kStep);
  EXPECT_EQ(ParseClientRequest(R"({"type":"restart"})")->command, PlayerCommand::kRestart);
  EXPECT_EQ(ParseClientRequest(R"({"type":"speed","factor":2.5})")->speed, 2.5);
}

TEST(ClientRequestTest, EverythingElseIsNone) {
  for (const char* const text : {"",
                                 "{",
                                 "null",
                                 "[]",
                                 "5",
                                 "\"shown\"",
                                 "{}",
                                 R"({"type":5})",
                                 R"({"type":"nonsense"})",
                                 R"({"type":"choose"})",
                                 R"({"type":"choose","id":"7"})",
                                 R"({"type":"choose","id":1.5})",
                                 R"({"type":"model"})",
                                 R"({"type":"model","name":"../fan"})",
                                 R"({"type":"model","name":""})",
                                 R"({"type":"speed"})",
                                 R"({"type":"speed","factor":0})",
                                 R"({"type":"speed","factor":-1})",
                                 R"({"type":"speed","factor":1e9})",
                                 R"({"type":"speed","factor":"fast"})",
                                 "{\"type\":\"shown\"}x",
                                 "\xff\xfe"}) {
    EXPECT_FALSE(ParseClientRequest(text)) << text;
  }
}

TEST(ClientRequestTest, ALongTextIsNone) {
  const std::string spaces(kMaxRequestBytes, ' ');
  EXPECT_FALSE(ParseClientRequest(R"({"type":"shown"})" + spaces));
  EXPECT_FALSE(ParseClientRequest(std::string(kMaxRequestBytes, '[')));
}

TEST(ClientRequestTest, RandomBytesAreNone) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> byte(0, 255);
  std::uniform_int_distribution<std::size_t> length(0, 60);
  for (int i = 0; i < 5000; ++i) {
    std::string text(length(random), ' ');
    for (char& c : text) c = static_cast<char>(byte(random));
    EXPECT_FALSE(ParseClientRequest(text));
  }
}

TEST(RequestBudgetTest, LetsThroughSoManyInARowAndSoManyASecond) {
  RequestBudget budget;
  RequestBudget::Time now{std::chrono::hours(1)};
  int num_taken = 0;
  while (num_taken < 10'000 && budget.Take(now)) ++num_taken;
  EXPECT_EQ(num_taken, static_cast<int>(RequestBudget::kInARow));
  now += std::chrono::seconds(1);
  num_taken = 0;
  while (num_taken < 10'000 && budget.Take(now)) ++num_taken;
  EXPECT_EQ(num_taken, static_cast<int>(RequestBudget::kPerSecond));
}

TEST(RequestBudgetTest, DoesNotSaveUpMoreThanInARow) {
  RequestBudget budget;
  RequestBudget::Time now{std::chrono::hours(1)};
  EXPECT_TRUE(budget.Take(now));
  now += std::chrono::hours(10);
  int num_taken = 0;
  while (num_taken < 10'000 && budget.Take(now)) ++num_taken;
  EXPECT_EQ(num_taken, static_cast<int>(RequestBudget::kInARow));
}

}  // namespace
}  // namespace rimod
