#include "viewer_tools/case_folder.h"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "io/files.h"

namespace rimod {
namespace {

using Json = nlohmann::ordered_json;

// A scan's name may hold anything; a file's may not.
std::string SafeName(std::string name) {
  for (char& c : name) {
    const bool safe = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                      c == '-' || c == '_' || c == '.';
    if (!safe) c = '_';
  }
  constexpr std::size_t kLongest = 100;
  return name.substr(0, kLongest);
}

}  // namespace

std::string CaseFolder::PathOf(const std::string& name) const {
  return (std::filesystem::path(folder_) / name).string();
}

std::string CaseFolder::Make() const {
  std::error_code cause;
  std::filesystem::create_directories(folder_, cause);
  return cause ? folder_ + ": the folder cannot be made: " + cause.message() : "";
}

std::string CaseFolder::Add(int number, const FoundCase& found, const std::string& png) {
  const ReportCase& words = found.words;
  const std::string name = SafeName(fmt::format("{:03}-{}-{}-{}", number, CaseKindText(words.kind),
                                                words.class_name, words.scan)) +
                           ".png";
  Json line = {{"kind", CaseKindText(words.kind)},
               {"scan", words.scan},
               {"class", words.class_name},
               {"cause", words.cause}};
  if (!png.empty()) line["picture"] = name;
  if (found.object) {
    line["visible"] = found.object->visible;
    line["points"] = found.object->num_points;
    line["distance"] = found.object->distance;
  }
  if (found.score) line["score"] = *found.score;
  if (found.score_at_label) line["score_at_label"] = *found.score_at_label;
  line["detail"] = words.detail;
  // Names of scans need not be UTF-8, JSON must.
  lines_ += line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  return png.empty() ? "" : WriteFileAtomically(PathOf(name), png);
}

std::string CaseFolder::WriteList() const {
  return WriteFileAtomically(PathOf("cases.jsonl"), lines_);
}

}  // namespace rimod
