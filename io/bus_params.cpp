#include "io/bus_params.h"

#include "rimod/check.h"

namespace rimod {

void BusParams::Validate() const {
  CheckWithin("max_megabytes_per_second", max_megabytes_per_second, 0.1, 10000.0);
  CheckWithin("max_waiting_scans", max_waiting_scans, 1, 1000);
  CheckWithin("idle_time", idle_time, 0.05, 3600.0);
  CheckWithin("quiet_time", quiet_time, 0.01, 3600.0);
  CheckWithin("join_patience", join_patience, 0.1, 3600.0);
  CheckWithin("shard_patience", shard_patience, 0.1, 3600.0);
}

}  // namespace rimod
