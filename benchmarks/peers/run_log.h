#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "rimod/detection.h"

namespace rimod::peers {

// Milliseconds of wall and of processor time.
struct Times {
  double wall_ms = 0.0;
  double cpu_ms = 0.0;
};
Times operator-(const Times& a, const Times& b);
Times Now();

// What detections are scored by: our judgement, or the library's own measure.
enum class Measure { kJudged, kOwn };

// Detections as lines of JSON, on stdout as judged, in a file by the library's own measure; times
// on stderr.
class RunLog {
 public:
  // own_file may be empty: none. Throws std::runtime_error when it cannot be written.
  explicit RunLog(const std::string& own_file);
  void Write(Measure measure, const std::string& scan, const std::vector<Detection>& detections);
  void TellLearnt(std::size_t num_models, const Times& took);
  // found: by the library; judged: by our judgement of what it proposes.
  void Tell(const std::string& scan, std::size_t num_points, std::size_t num_proposals,
            const Times& found, const Times& judged);
  // Medians over all scans, which benchmarks/peers/run reads.
  void TellAll() const;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Closer> own_;
  std::vector<Times> found_, judged_;
};

}  // namespace rimod::peers
