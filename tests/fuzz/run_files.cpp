// What rimod-run starts.

#include "launcher/run_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const rimod::InputFile file("run.yaml");
  const rimod::RunFileResult result = rimod::ReadRunFile(file.Write(bytes, size));
  rimod::Require(result.run_file.has_value() == result.error.empty(), "a run file or an error");
  if (result.run_file) rimod::Require(!result.run_file->processes.empty(), "processes");
  return 0;
}
