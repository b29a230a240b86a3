#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace rimod {

// That a text holds all of these words.
inline testing::AssertionResult Mentions(const std::string& text,
                                         std::initializer_list<std::string> words) {
  for (const std::string& word : words) {
    if (text.find(word) == std::string::npos) {
      return testing::AssertionFailure() << "'" << text << "' does not mention " << word;
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace rimod
