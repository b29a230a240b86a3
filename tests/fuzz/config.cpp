// Configuration files. What is taken is written and read back as the same text.

#include "io/config.h"

#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const rimod::ConfigurationResult result =
      rimod::ParseConfiguration(rimod::TextOf(bytes, size), "input");
  rimod::Require(result.configuration.has_value() == result.error.empty(),
                 "a configuration or an error");
  if (!result.configuration) return 0;
  const std::string text = rimod::DumpConfiguration(*result.configuration);
  const rimod::ConfigurationResult again = rimod::ParseConfiguration(text, "dump");
  rimod::Require(again.configuration.has_value(), "a dump can be read");
  rimod::Require(rimod::DumpConfiguration(*again.configuration) == text, "a dump reads back");
  return 0;
}
