#include "web_viewer/page_files.h"

#include <array>
#include <utility>

#include "io/files.h"

namespace rimod {
namespace {

struct FileType {
  const char* ending;
  const char* mime_type;
};
constexpr std::array<FileType, 4> kFileTypes = {{{".html", "text/html; charset=utf-8"},
                                                 {".js", "text/javascript; charset=utf-8"},
                                                 {".css", "text/css; charset=utf-8"},
                                                 {".svg", "image/svg+xml"}}};
constexpr std::int64_t kMaxFileBytes = 20'000'000;

}  // namespace

PageFiles LoadPageFiles(const std::string& folder) {
  PageFiles files;
  for (const FileType& type : kFileTypes) {
    const FolderListing listing = ListFolder(folder, "", type.ending);
    if (!listing.error.empty()) return {{}, listing.error};
    for (const std::string& path : listing.paths) {
      FileBytes file = ReadFile(path, kMaxFileBytes);
      if (!file.bytes) return {{}, file.error};
      files.by_path[path.substr(path.rfind('/'))] = {type.mime_type, std::move(*file.bytes)};
    }
  }
  const auto index = files.by_path.find("/index.html");
  if (index == files.by_path.end()) return {{}, folder + ": no index.html"};
  files.by_path["/"] = index->second;
  return files;
}

}  // namespace rimod
