#pragma once

namespace rimod {

// How processes behave on the bus; section `bus` of the configuration.
struct BusParams {
  double max_megabytes_per_second =
      20.0;  // large messages are sent at this rate at most; 0.1 .. 10000
  int max_waiting_scans =
      1;  // complete scans that wait; further ones push the oldest out; 1 .. 1000
  double idle_time =
      1.0;  // s, the assembler ends a sweep when nothing came for so long; 0.05 .. 3600
  // s, when no line came for so long, and for three times the longest gap before, the assembler
  // sends the scan; once more, longer, if the sweep goes on after all; 0.01 .. 3600, idle_time and
  // more = only at the sweep's end
  double quiet_time = 0.08;
  // The assembler sends what a sweep grows by at once, so that the extractor has the scan at the
  // sweep's end; costs the scan's bytes a second time.
  bool scan_ahead = true;
  double join_patience = 5.0;  // s, wait for missing sections and partners of a scan; 0.1 .. 3600
  double shard_patience =
      5.0;  // s, the fuser waits so long after the first answer to a scan; 0.1 .. 3600
  void Validate() const;  // throws std::invalid_argument naming field and value
};

}  // namespace rimod
