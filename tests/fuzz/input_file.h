#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace rimod {

// An input of a fuzzer as a file in a folder of its own, for readers that take a path. The folder
// is gone at the end of the program.
class InputFile {
 public:
  explicit InputFile(const std::string& name) {
    std::string folder = (std::filesystem::temp_directory_path() / "rimod_fuzz_XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) std::abort();
    folder_ = folder;
    path_ = folder + "/" + name;
  }
  ~InputFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& Write(const std::uint8_t* bytes, std::size_t size) const {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    return path_;
  }
  const std::string& folder() const { return folder_; }

 private:
  std::string folder_, path_;
};

// Ends the program, which is a finding, where a law does not hold.
inline void Require(bool law, const char* text) {
  if (law) return;
  std::fprintf(stderr, "broken: %s\n", text);
  std::abort();
}

inline std::string TextOf(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace rimod
