#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "rimod/detection.h"
#include "rimod/early_params.h"
#include "rimod/model_database.h"
#include "rimod/object_model.h"
#include "rimod/range_image.h"
#include "rimod/sweep.h"

namespace rimod {

// The share of a model's surface that would face the sensor at this pose and of which nothing is
// known yet: it projects outside of the image or where neither the pixel nor one of its neighbours
// was observed. 0 .. 1; 1 for a model no point of which faces the sensor.
double UnseenShare(const RangeImage& image, const ObjectModel& model,
                   const Eigen::Isometry3d& T_sensor_object);

// A detection in what is known of a sweep.
struct EarlySighting {
  Detection detection;
  double unseen_share = 0.0;  // see UnseenShare
};

// The detections of an image, in their order, each with its unseen share. Their classes must be
// among the database's models.
std::vector<EarlySighting> SightingsOf(const std::vector<Detection>& detections,
                                       const RangeImage& image, const ModelDatabase& database);

enum class EarlyStatus { kNew, kConfirmed, kUnseen, kWithdrawn };

// An object that was told.
struct EarlyObject {
  std::int64_t id = 0;
  EarlyStatus status = EarlyStatus::kNew;
  Time first_told{0};         // last beam that was known then
  double unseen_share = 0.0;  // as last seen
  Detection detection;        // as last seen
};

// Follows the objects of a sweep from one look at the growing scan to the next, and to the scan.
//
// An object is told when it was sighted min_sightings times in a row with enough score, while
// no more than max_unseen_share of it was still to come; told objects are withdrawn when more than
// max_misses looks in a row do not show them, or when the scan does not. Sightings are one object
// when their class is the same and their centres are near (same_object_distance); nearest pairs
// first.
class EarlyTracker {
 public:
  // Throws std::invalid_argument for parameters out of range. Ids begin at 1.
  explicit EarlyTracker(const EarlyParams& params);

  // A look at what is known of a sweep. Returns all that was told of the sweep so far, by id. A
  // sweep that begins at another time than the one before is a new one: its objects are others.
  std::vector<EarlyObject> Update(Time sweep_begin, Time known_until,
                                  const std::vector<EarlySighting>& sightings);

  // The sweep has ended and these are its detections. Returns all of them, in their order, told
  // before (kConfirmed) or not (kNew), then what is withdrawn, by id. Forgets the sweep.
  std::vector<EarlyObject> Finish(Time sweep_begin, Time known_until,
                                  const std::vector<Detection>& detections);

 private:
  struct Track {
    EarlyObject object;
    int num_sightings = 0;  // in a row
    int num_misses = 0;     // in a row
    bool told = false;
  };

  void Begin(Time sweep_begin);
  // For each detection the index of its track, -1: none.
  std::vector<int> Associate(const std::vector<EarlySighting>& sightings) const;
  void See(const EarlySighting& sighting, Time known_until, Track* track);
  void Miss(Track* track) const;

  EarlyParams params_;
  std::int64_t next_id_ = 1;
  Time sweep_begin_{0};
  std::vector<Track> tracks_;  // of the sweep at hand, by id
};

}  // namespace rimod
