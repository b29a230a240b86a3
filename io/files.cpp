#include "io/files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

namespace rimod {
namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

std::string Cause() { return std::strerror(errno); }

// Writes all bytes to the open file and flushes them to the disk.
bool WriteAll(int descriptor, const std::string& bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t n = ::write(descriptor, bytes.data() + written, bytes.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    written += static_cast<std::size_t>(n);
  }
  return ::fsync(descriptor) == 0;
}

}  // namespace

FileBytes ReadFile(const std::string& path, std::int64_t max_bytes) {
  FileBytes result;
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) {
    result.error = path + ": cannot be read: " + (failure ? failure.message() : "does not exist");
    return result;
  }
  if (!std::filesystem::is_regular_file(status)) {
    result.error = path + ": is a folder or device, not a file";
    return result;
  }
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure || size > static_cast<std::uintmax_t>(max_bytes)) {
    result.error = path + ": " +
                   (failure ? failure.message()
                            : "has " + std::to_string(size) + " bytes, more than the " +
                                  std::to_string(max_bytes) + " that are read");
    return result;
  }
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    result.error = path + ": cannot be read: " + Cause();
    return result;
  }
  std::string bytes(size, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (std::ferror(file.get())) {
    result.error = path + ": reading failed: " + Cause();
  } else {
    result.bytes = std::move(bytes);
  }
  return result;
}

std::string ReadFileStart(const std::string& path, std::int64_t max_bytes) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return "";
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) return "";
  std::string bytes(static_cast<std::size_t>(max_bytes), '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  return bytes;
}

std::string WriteFileAtomically(const std::string& path, const std::string& bytes) {
  std::string temporary = path + ".XXXXXX";
  const int descriptor = ::mkstemp(temporary.data());
  if (descriptor < 0) return path + ": cannot be written: " + Cause();
  constexpr mode_t kReadableByAll = 0644;  // mkstemp gives 0600
  const bool written = WriteAll(descriptor, bytes) && ::fchmod(descriptor, kReadableByAll) == 0;
  std::string error = written ? "" : path + ": writing failed: " + Cause();
  if (::close(descriptor) != 0 && error.empty()) error = path + ": writing failed: " + Cause();
  if (error.empty() && std::rename(temporary.c_str(), path.c_str()) != 0) {
    error = path + ": cannot be written: " + Cause();
  }
  if (!error.empty()) ::unlink(temporary.c_str());
  return error;
}

FolderListing ListFolder(const std::string& folder, const std::string& prefix,
                         const std::string& suffix) {
  FolderListing listing;
  std::error_code failure;
  std::filesystem::directory_iterator entry(folder, failure);
  if (failure) {
    listing.error = folder + ": cannot be read as a folder: " + failure.message();
    return listing;
  }
  for (; !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure)) {
    const std::string name = entry->path().filename().string();
    if (name.size() >= prefix.size() + suffix.size() && name.rfind(prefix, 0) == 0 &&
        name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0) {
      listing.paths.push_back(entry->path().string());
    }
  }
  if (failure) listing.error = folder + ": reading the folder failed: " + failure.message();
  std::sort(listing.paths.begin(), listing.paths.end());
  return listing;
}

std::string FileStem(const std::string& path) {
  const std::filesystem::path name = std::filesystem::path(path).filename();
  const std::string ending = name.extension().string();
  const bool is_number = ending.find_first_not_of("0123456789", 1) == std::string::npos;
  return is_number ? name.string() : name.stem().string();
}

}  // namespace rimod
