#include "viewer_tools/html.h"

#include <gtest/gtest.h>

#include <random>

namespace rimod {
namespace {

TEST(HtmlTest, MarkupCharactersBecomeEntities) {
  EXPECT_EQ(EscapeHtml("<a href=\"x\" title='&'>"),
            "&lt;a href=&quot;x&quot; title=&#39;&amp;&#39;&gt;");
}

TEST(HtmlTest, OtherLanguagesStay) {
  EXPECT_EQ(EscapeHtml("Bür\u00f6 \u6905 \U0001F4BA"), "Bür\u00f6 \u6905 \U0001F4BA");
}

TEST(HtmlTest, WhatIsNotUtf8BecomesQuestionMarks) {
  EXPECT_EQ(EscapeHtml("a\xff z"), "a? z");
  EXPECT_EQ(EscapeHtml("\xc3"), "?");            // cut short
  EXPECT_EQ(EscapeHtml("\xc0\xbc"), "??");       // an overlong '<'
  EXPECT_EQ(EscapeHtml("\xed\xa0\x80"), "???");  // half a surrogate pair
  EXPECT_EQ(EscapeHtml(std::string("a\0b\x1b", 4)), "a?b?");
  EXPECT_EQ(EscapeHtml("a\tb\n"), "a\tb\n");
}

TEST(HtmlTest, NoBytesWhateverGiveMarkup) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int round = 0; round < 200; ++round) {
    std::string text(100, ' ');
    for (char& c : text) c = static_cast<char>(byte(random));
    const std::string escaped = EscapeHtml(text);
    EXPECT_EQ(escaped.find_first_of("<>\"'"), std::string::npos);
  }
}

TEST(HtmlTest, DataUriIsBase64) {
  EXPECT_EQ(DataUri("text/plain", ""), "data:text/plain;base64,");
  EXPECT_EQ(DataUri("text/plain", "M"), "data:text/plain;base64,TQ==");
  EXPECT_EQ(DataUri("text/plain", "Ma"), "data:text/plain;base64,TWE=");
  EXPECT_EQ(DataUri("text/plain", "Man"), "data:text/plain;base64,TWFu");
  EXPECT_EQ(DataUri("image/png", "\xff\xfe\xfd\xfc"), "data:image/png;base64,//79/A==");
}

}  // namespace
}  // namespace rimod
