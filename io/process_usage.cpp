#include "io/process_usage.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace rimod {
namespace {

std::int64_t Milliseconds(const timeval& time) {
  return std::int64_t{1000} * time.tv_sec + time.tv_usec / 1000;
}

std::int64_t ResidentKb() {
  std::ifstream file("/proc/self/statm");
  std::int64_t total_pages = 0;
  std::int64_t resident_pages = 0;
  if (!(file >> total_pages >> resident_pages)) return 0;
  return resident_pages * sysconf(_SC_PAGESIZE) / 1024;
}

}  // namespace

ProcessUsage CurrentProcessUsage() {
  ProcessUsage result;
  rusage usage = {};
  if (getrusage(RUSAGE_SELF, &usage) == 0) {
    result.cpu_ms = Milliseconds(usage.ru_utime) + Milliseconds(usage.ru_stime);
    result.peak_memory_kb = usage.ru_maxrss;
  }
  result.memory_kb = ResidentKb();
  // The kernel updates the peak now and then only.
  result.peak_memory_kb = std::max(result.peak_memory_kb, result.memory_kb);
  return result;
}

}  // namespace rimod
