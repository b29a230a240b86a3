#pragma once

namespace rimod {

// Names of counters in rimod.status_t that readers may rely on.

// "dropped <cause>": scans, or parts of them, given up; they add up to num_dropped.
constexpr char kDroppedPrefix[] = "dropped ";
// "rejected <channel>: <cause>": messages that could not be used; they add up to num_rejected.
constexpr char kRejectedPrefix[] = "rejected ";

// Processor time of all threads since the process began, ms.
constexpr char kCpuCounter[] = "cpu ms";
// What the process holds now, and the most that it ever held, kB (1024 bytes).
constexpr char kMemoryCounter[] = "memory kB";
constexpr char kPeakMemoryCounter[] = "peak memory kB";
// "sends <channel>" is 1: where the process sends its results (io/sender_watch.h).
constexpr char kSendsPrefix[] = "sends ";
// Scans that have come and wait for the computation.
constexpr char kWaitingScansCounter[] = "waiting scans";
// Messages that are ready and wait to be sent.
constexpr char kWaitingMessagesCounter[] = "waiting messages";

}  // namespace rimod
