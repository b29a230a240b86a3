#pragma once

#include <map>
#include <string>

namespace rimod {

// A file of the page, as it is served.
struct PageFile {
  std::string mime_type;
  std::string bytes;
};

struct PageFiles {
  std::map<std::string, PageFile> by_path;  // "/page.js"; index.html is also "/"
  std::string error;                        // names the folder or file and the cause
};

// Reads the page into memory: index.html and whatever .js, .css, .svg lie beside it.
PageFiles LoadPageFiles(const std::string& folder);

}  // namespace rimod
