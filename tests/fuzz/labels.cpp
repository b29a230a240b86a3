// What people and other programs write for rimod-report and rimod-snapshot: labels, detections.

#include "io/label_file.h"
#include "tests/fuzz/input_file.h"
#include "viewer_tools/detection_lines.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const rimod::InputFile file("lines");
  const std::string text = rimod::TextOf(bytes, size);
  const rimod::LabelFile labels = rimod::ParseLabels(text, "input");
  rimod::Require(labels.error.empty() || labels.scans.empty(), "labels or an error");
  const rimod::ParsedDetectionLine line = rimod::ParseDetectionLine(text);
  rimod::Require(line.line.has_value() == line.error.empty(), "a detection or an error");
  rimod::ReadDetectionLines(file.Write(bytes, size));
  return 0;
}
