#include <gtest/gtest.h>

#include <string>

#include "tests/support/private_network.h"

// Main of tests that start processes which speak LCM.
int main(int argc, char** argv) {
  bool only_list = false;
  for (int i = 1; i < argc; ++i) only_list |= std::string(argv[i]) == "--gtest_list_tests";
  if (!only_list) rimod::EnterPrivateNetwork(argv);
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
