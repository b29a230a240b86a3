#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rimod {

// The bytes of a file, or why there are none.
struct FileBytes {
  std::optional<std::string> bytes;
  std::string error;  // names the file and the cause
};

// Reads a whole regular file of at most max_bytes; folders, devices and pipes are refused.
FileBytes ReadFile(const std::string& path, std::int64_t max_bytes);

// Its first bytes, at most max_bytes; empty when it cannot be read or is no regular file.
std::string ReadFileStart(const std::string& path, std::int64_t max_bytes);

// Writes bytes to a temporary name beside path, flushes them to the disk and renames: a reader
// never sees half a file, a failure leaves the old one. Returns an error text, empty when done.
std::string WriteFileAtomically(const std::string& path, const std::string& bytes);

// The files of a folder whose names begin and end so, sorted by name, with the folder in front.
struct FolderListing {
  std::vector<std::string> paths;
  std::string error;  // names the folder; empty when it could be read
};
FolderListing ListFolder(const std::string& folder, const std::string& prefix,
                         const std::string& suffix);

// "rooms/000.pcd" -> "000": the name without folder and ending. A number is no ending:
// lcm-logger calls its files "lcmlog-2011-05-01.00".
std::string FileStem(const std::string& path);

}  // namespace rimod
