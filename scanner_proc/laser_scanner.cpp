#include "scanner_proc/laser_scanner.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rimod::simulation {
namespace {

struct Echo {
  Hit hit;
  double signal = 0.0;
  bool middle = false;  // of the beam's middle ray
};

// Rays of a beam, evenly spread over its disc (a sunflower), the first in its middle.
std::vector<Eigen::Vector2d> MakeBundle(double divergence, int num_rays) {
  std::vector<Eigen::Vector2d> bundle = {Eigen::Vector2d::Zero()};
  if (divergence == 0.0) return bundle;
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  for (int i = 1; i < num_rays; ++i) {
    const double radius = 0.5 * divergence * std::sqrt(static_cast<double>(i) / (num_rays - 1));
    bundle.emplace_back(radius * std::cos(i * golden_angle), radius * std::sin(i * golden_angle));
  }
  return bundle;
}

// A direction turned by small angles to the left and up, seen along it.
Eigen::Vector3d Deflected(const Eigen::Vector3d& direction, const Eigen::Vector3d& left,
                          const Eigen::Vector3d& up, const Eigen::Vector2d& angles) {
  return (direction + std::tan(angles.x()) * left + std::tan(angles.y()) * up).normalized();
}

// Echoes [begin, end) of a list sorted by range that the scanner takes for one surface.
struct EchoGroup {
  std::size_t begin = 0, end = 0;
  double signal = 0.0;
};

// The surface that sends most light back; the nearer one of equals.
EchoGroup StrongestGroup(const std::vector<Echo>& echoes, double mixing_distance) {
  EchoGroup strongest;
  EchoGroup current;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const bool apart = i > 0 && echoes[i].hit.range - echoes[i - 1].hit.range > mixing_distance;
    if (apart) current = EchoGroup{i, i, 0.0};
    current.end = i + 1;
    current.signal += echoes[i].signal;
    if (current.signal > strongest.signal) strongest = current;
  }
  return strongest;
}

}  // namespace

// Random numbers of one beam: SplitMix64, seeded by what the beam is.
class LaserScanner::Random {
 public:
  Random(std::uint64_t seed, std::uint64_t line, std::uint64_t beam) : state_(seed) {
    state_ = Next() ^ line;
    state_ = Next() ^ beam;
  }

  // 0 .. below 1.
  double Uniform() { return static_cast<double>(Next() >> 11) * 0x1.0p-53; }
  // Normal distribution of mean 0, deviation 1 (Box and Muller).
  double Normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
    return radius * std::cos(2.0 * M_PI * Uniform());
  }

 private:
  std::uint64_t Next() {
    state_ += 0x9e3779b97f4a7c15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

LaserScanner::LaserScanner(const Sensor& sensor, const Noise& noise, const RayCaster& caster,
                           std::uint64_t seed, std::int64_t start_utime)
    : sensor_(sensor),
      noise_(noise),
      caster_(caster),
      seed_(seed),
      start_utime_(start_utime),
      bundle_(MakeBundle(noise.beam_divergence, noise.rays_per_beam)) {
  const double range = std::abs(sensor.tilt_end - sensor.tilt_start);
  num_lines_ = static_cast<int>(std::lround(range / sensor.tilt_step)) + 1;
  num_pause_lines_ = static_cast<int>(std::lround(sensor.pause / sensor.line_period));
}

Time LaserScanner::LineTime(std::int64_t line) const {
  return Time(start_utime_ + std::llround(static_cast<double>(line) * sensor_.line_period * 1e6));
}

double LaserScanner::TiltAt(double lines) const {
  const double sweep = std::floor(lines / LinesPerSweep());
  const double turned = std::min<double>(lines - sweep * LinesPerSweep(), num_lines_);
  const bool returning = std::fmod(sweep, 2.0) != 0.0;
  const double sign = sensor_.tilt_end < sensor_.tilt_start ? -1.0 : 1.0;
  return sensor_.tilt_start + sign * sensor_.tilt_step * (returning ? num_lines_ - turned : turned);
}

Eigen::Isometry3d LaserScanner::PoseAt(double lines) const {
  const double seconds = lines * sensor_.line_period;
  const double turned = sensor_.turn_rate * seconds;
  // The carrier drives an arc: a chord in the mean direction, shortened by sin(x) / x.
  const double half = 0.5 * turned;
  const double shortening = half == 0.0 ? 1.0 : std::sin(half) / half;
  const double chord = sensor_.speed * seconds * shortening;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = sensor_.position + chord * Eigen::Vector3d(std::cos(sensor_.yaw + half),
                                                               std::sin(sensor_.yaw + half), 0.0);
  T.rotate(Eigen::AngleAxisd(sensor_.yaw + turned, Eigen::Vector3d::UnitZ()));
  T.rotate(Eigen::AngleAxisd(TiltAt(lines), Eigen::Vector3d::UnitY()));
  return T;
}

TimedPose LaserScanner::TimedPoseOf(std::int64_t line) const {
  return {LineTime(line), PoseAt(static_cast<double>(line))};
}

ScannedLine LaserScanner::Scan(std::int64_t line) const {
  const bool shifted = sensor_.interlaced && line % 2 != 0;
  const int num_beams = shifted ? sensor_.num_beams - 1 : sensor_.num_beams;
  ScannedLine scanned;
  scanned.line.time = LineTime(line);
  // As a message tells them.
  scanned.line.angle_step = static_cast<float>(sensor_.angle_step);
  scanned.line.first_angle =
      static_cast<float>(sensor_.first_angle + (shifted ? 0.5 * sensor_.angle_step : 0.0));
  for (int i = 0; i < num_beams; ++i) {
    const double lines = static_cast<double>(line) + static_cast<double>(i) / sensor_.num_beams;
    const Eigen::Isometry3d T_scene_laser = PoseAt(lines);
    const double angle = scanned.line.first_angle + i * scanned.line.angle_step;
    Random random(seed_, static_cast<std::uint64_t>(line), static_cast<std::uint64_t>(i));
    const double angle_error = noise_.angle_sigma * random.Normal();
    const double tilt_error = noise_.angle_sigma * random.Normal();
    const Eigen::Vector3d exact(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d left(-exact.y(), exact.x(), 0.0);
    Beam beam;
    beam.ray.origin = T_scene_laser.translation();
    beam.ray.direction = T_scene_laser.linear() * Deflected(exact, left, Eigen::Vector3d::UnitZ(),
                                                            {angle_error, tilt_error});
    scanned.line.ranges.push_back(Measure(&beam, &random));
    scanned.beams.push_back(beam);
  }
  return scanned;
}

float LaserScanner::Measure(Beam* beam, Random* random) const {
  const float no_return = static_cast<float>(sensor_.no_return);
  // Drawn for every beam, so that a reading does not depend on which noises are on.
  const double range_error = noise_.range_sigma * random->Normal();
  const double drop_out = random->Uniform();
  const double darkness = random->Uniform();

  const Eigen::Vector3d left = beam->ray.direction.unitOrthogonal();
  const Eigen::Vector3d up = beam->ray.direction.cross(left);
  std::vector<Echo> echoes;
  for (std::size_t i = 0; i < bundle_.size(); ++i) {
    Ray ray = beam->ray;
    if (i > 0) ray.direction = Deflected(ray.direction, left, up, bundle_[i]);
    const std::optional<Hit> hit = caster_.Cast(ray, sensor_.max_range);
    if (!hit) continue;
    if (i == 0) beam->object_hit = static_cast<int>(hit->object);
    const double attenuation = std::min(1.0, kFullSignalRange / hit->range);
    const double signal = hit->reflectivity * hit->cos_incidence * attenuation * attenuation;
    echoes.push_back({*hit, signal / static_cast<double>(bundle_.size()), i == 0});
  }
  std::stable_sort(echoes.begin(), echoes.end(),
                   [](const Echo& a, const Echo& b) { return a.hit.range < b.hit.range; });
  const EchoGroup group = StrongestGroup(echoes, noise_.mixing_distance);
  if (group.begin == group.end) return no_return;

  const double lost = noise_.dark_signal > 0.0 ? std::exp(-group.signal / noise_.dark_signal) : 0.0;
  if (drop_out < noise_.drop_out || darkness < lost) return no_return;
  double range = 0.0;
  const Echo* main_echo = &echoes[group.begin];
  for (std::size_t i = group.begin; i < group.end; ++i) {
    range += echoes[i].hit.range * echoes[i].signal / group.signal;
    if (echoes[i].middle || (!main_echo->middle && echoes[i].signal > main_echo->signal)) {
      main_echo = &echoes[i];
    }
  }
  range = std::max(0.0, range + range_error);
  if (noise_.range_step > 0.0) range = std::round(range / noise_.range_step) * noise_.range_step;
  if (range >= sensor_.max_range) return no_return;
  beam->object_measured = static_cast<int>(main_echo->hit.object);
  return static_cast<float>(range);
}

}  // namespace rimod::simulation
