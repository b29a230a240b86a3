#include "rimod/early_detection.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "rimod/check.h"

namespace rimod {
namespace {

// Sparse scans leave single pixels empty: one counts as unseen only with all its neighbours.
bool SeenAround(const RangeImage& image, int row, int column) {
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = column - 1; c <= column + 1; ++c) {
      if (image.grid().Contains(r, c) && image.pixel(r, c) != Pixel::kNeverObserved) return true;
    }
  }
  return false;
}

Eigen::Vector3d CentreOf(const Detection& detection) {
  return detection.T_local_object * Eigen::Vector3d(0.5 * (detection.box_min + detection.box_max));
}

double DiameterOf(const Detection& detection) {
  return (detection.box_max - detection.box_min).norm();
}

}  // namespace

void EarlyParams::Validate() const {
  CheckWithin("early period", period, 0.05, 3600.0);
  CheckWithin("early max_unseen_share", max_unseen_share, 0.0, 1.0);
  CheckWithin("early min_score", min_score, 0.0, 1.0);
  CheckWithin("early min_sightings", min_sightings, 1, 100);
  CheckWithin("early max_misses", max_misses, 0, 100);
  CheckWithin("early same_object_distance", same_object_distance, 0.0, 10.0);
}

double UnseenShare(const RangeImage& image, const ObjectModel& model,
                   const Eigen::Isometry3d& T_sensor_object) {
  int num_facing = 0, num_unseen = 0;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Eigen::Vector3d p_sensor = T_sensor_object * model.points[i].cast<double>();
    const Eigen::Vector3d normal = T_sensor_object.linear() * model.normals[i].cast<double>();
    if (normal.dot(p_sensor) >= 0.0) continue;
    ++num_facing;
    if (image.grid().size() == 0) {
      ++num_unseen;
      continue;
    }
    const PixelPosition position = Project(image.grid(), p_sensor);
    const int row = static_cast<int>(std::floor(position.row));
    const int column = static_cast<int>(std::floor(position.column));
    if (!image.grid().Contains(row, column) || !SeenAround(image, row, column)) ++num_unseen;
  }
  return num_facing > 0 ? static_cast<double>(num_unseen) / num_facing : 1.0;
}

std::vector<EarlySighting> SightingsOf(const std::vector<Detection>& detections,
                                       const RangeImage& image, const ModelDatabase& database) {
  const Eigen::Isometry3d T_sensor_local = image.T_local_sensor().inverse();
  std::vector<EarlySighting> sightings;
  for (const Detection& detection : detections) {
    const auto model =
        std::find_if(database.models().begin(), database.models().end(),
                     [&detection](const ObjectModel& m) { return m.name == detection.class_name; });
    if (model == database.models().end()) continue;
    sightings.push_back(
        {detection, UnseenShare(image, *model, T_sensor_local * detection.T_local_object)});
  }
  return sightings;
}

EarlyTracker::EarlyTracker(const EarlyParams& params) : params_((params.Validate(), params)) {}

std::vector<EarlyObject> EarlyTracker::Update(Time sweep_begin, Time known_until,
                                              const std::vector<EarlySighting>& sightings) {
  Begin(sweep_begin);
  const std::vector<int> track_of = Associate(sightings);
  std::vector<char> seen(tracks_.size(), 0);
  for (const int track : track_of) {
    if (track >= 0) seen[static_cast<std::size_t>(track)] = 1;
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) Miss(&tracks_[i]);
  }
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (track_of[i] < 0) {
      tracks_.emplace_back();
      tracks_.back().object.id = next_id_++;
    }
    Track* const track = track_of[i] < 0 ? &tracks_.back() : &tracks_[track_of[i]];
    See(sightings[i], known_until, track);
  }
  std::vector<EarlyObject> told;
  for (const Track& track : tracks_) {
    if (track.told) told.push_back(track.object);
  }
  return told;
}

std::vector<EarlyObject> EarlyTracker::Finish(Time sweep_begin, Time known_until,
                                              const std::vector<Detection>& detections) {
  Begin(sweep_begin);
  std::vector<EarlySighting> sightings;
  for (const Detection& detection : detections) sightings.push_back({detection, 0.0});
  const std::vector<int> track_of = Associate(sightings);
  std::vector<char> found(tracks_.size(), 0);
  std::vector<EarlyObject> objects;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    EarlyObject object;
    object.detection = detections[i];
    if (track_of[i] >= 0) {
      const Track& track = tracks_[track_of[i]];
      found[static_cast<std::size_t>(track_of[i])] = 1;
      object.id = track.object.id;
      object.status = track.told ? EarlyStatus::kConfirmed : EarlyStatus::kNew;
      object.first_told = track.told ? track.object.first_told : known_until;
    } else {
      object.id = next_id_++;
      object.first_told = known_until;
    }
    objects.push_back(std::move(object));
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (found[i] || !tracks_[i].told) continue;
    objects.push_back(tracks_[i].object);
    objects.back().status = EarlyStatus::kWithdrawn;
  }
  tracks_.clear();
  return objects;
}

void EarlyTracker::Begin(Time sweep_begin) {
  if (sweep_begin != sweep_begin_) tracks_.clear();
  sweep_begin_ = sweep_begin;
}

std::vector<int> EarlyTracker::Associate(const std::vector<EarlySighting>& sightings) const {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // distance, sighting, track
  for (std::size_t s = 0; s < sightings.size(); ++s) {
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      const Detection& known = tracks_[t].object.detection;
      const Detection& seen = sightings[s].detection;
      if (known.class_name != seen.class_name) continue;
      const double distance = (CentreOf(known) - CentreOf(seen)).norm();
      if (distance <= params_.same_object_distance * DiameterOf(seen))
        pairs.emplace_back(distance, s, t);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> track_of(sightings.size(), -1);
  std::vector<char> taken(tracks_.size(), 0);
  for (const auto& [distance, s, t] : pairs) {
    if (track_of[s] >= 0 || taken[t]) continue;
    track_of[s] = static_cast<int>(t);
    taken[t] = 1;
  }
  return track_of;
}

void EarlyTracker::See(const EarlySighting& sighting, Time known_until, Track* track) {
  track->object.detection = sighting.detection;
  track->object.unseen_share = sighting.unseen_share;
  track->num_misses = 0;
  const bool evident = sighting.detection.score >= params_.min_score &&
                       sighting.unseen_share <= params_.max_unseen_share;
  track->num_sightings = evident ? track->num_sightings + 1 : 0;
  if (track->told) {
    track->object.status = EarlyStatus::kConfirmed;
  } else if (track->num_sightings >= params_.min_sightings) {
    track->told = true;
    track->object.status = EarlyStatus::kNew;
    track->object.first_told = known_until;
  }
}

void EarlyTracker::Miss(Track* track) const {
  track->num_sightings = 0;
  ++track->num_misses;
  track->object.status =
      track->num_misses > params_.max_misses ? EarlyStatus::kWithdrawn : EarlyStatus::kUnseen;
}

}  // namespace rimod
