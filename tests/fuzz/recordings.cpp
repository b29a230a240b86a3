// The model.json of a recording.

#include "io/label_file.h"
#include "io/recording.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const rimod::InputFile file("model.json");
  file.Write(bytes, size);
  const rimod::RecordingResult result = rimod::ReadRecordingDescription(file.folder());
  rimod::Require(result.recording.has_value() == result.error.empty(), "a recording or an error");
  rimod::ReadClassName(file.folder());
  rimod::ReadSymmetry(file.folder());
  return 0;
}
