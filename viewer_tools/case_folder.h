#pragma once

#include <string>

#include "viewer_tools/report_cases.h"

namespace rimod {

// A folder with a picture of each case and a list of them, cases.jsonl: a JSON object a line with
// the picture's name, kind, scan, class, cause, detail and what else is known of the case.
class CaseFolder {
 public:
  explicit CaseFolder(std::string folder) : folder_(std::move(folder)) {}

  // Makes the folder when it is missing. All functions return an error text, empty when done.
  std::string Make() const;
  // Writes the picture (bytes of a PNG, none: no file) and keeps the line. number: of the case.
  std::string Add(int number, const FoundCase& found, const std::string& png);
  std::string WriteList() const;

 private:
  std::string PathOf(const std::string& name) const;

  std::string folder_;
  std::string lines_;
};

}  // namespace rimod
