#pragma once

#include <cstdint>

namespace rimod {

// What this process takes of the machine; 0 where the system does not tell.
struct ProcessUsage {
  std::int64_t cpu_ms = 0;          // of all threads, since the process began
  std::int64_t memory_kb = 0;       // resident now; kB of 1024 bytes
  std::int64_t peak_memory_kb = 0;  // the most that was ever resident
};
ProcessUsage CurrentProcessUsage();

}  // namespace rimod
