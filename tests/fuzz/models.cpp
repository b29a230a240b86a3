// Model files. The fuzzer cannot guess a checksum: the input's first byte says whether the right
// one is put behind the others.

#include <zlib.h>

#include "io/model_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  std::string file = rimod::TextOf(bytes + 1, size - 1);
  if (bytes[0] % 2 == 0) {
    const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(file.data()), file.size());
    for (int shift = 24; shift >= 0; shift -= 8) file += static_cast<char>((sum >> shift) & 0xff);
  }
  const rimod::ModelFileResult result = rimod::DecodeModelFile(file, "input");
  rimod::Require(result.model.has_value() == result.error.empty(), "a model or an error");
  if (!result.model) return 0;
  const std::string again = rimod::EncodeModelFile(*result.model);
  const rimod::ModelFileResult reread = rimod::DecodeModelFile(again, "again");
  rimod::Require(reread.model.has_value(), "a model that was read can be written and read");
  rimod::Require(rimod::EncodeModelFile(*reread.model) == again, "a model reads back");
  return 0;
}
