#include "web_viewer/log_player.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "io/laser_messages.h"
#include "io/message_codec.h"
#include "rimod/sweep_assembler.h"
#include "web_viewer/scene_feed.h"

namespace rimod {
namespace {

// s; recorded times may be anything.
double SecondsFrom(std::int64_t begin, std::int64_t end) {
  return 1e-6 * (static_cast<double>(end) - static_cast<double>(begin));
}

// How often pages are told where the log is.
constexpr std::chrono::milliseconds kTellPeriod{250};
// s, a longer silence in the log is passed over.
constexpr double kLongestSilence = 10.0;

}  // namespace

LogSummary SummariseLog(const std::string& path, const Channels& channels) {
  LogSummary summary;
  EventLogReader log(path);
  bool has_laser = false;
  bool has_poses = false;
  while (const std::optional<LogEvent> event = log.Next()) {
    if (event->number == 0) summary.begin = summary.end = event->utime;
    summary.end = std::max(summary.end, event->utime);
    has_laser |= event->channel == channels.laser;
    has_poses |= event->channel == channels.laser_to_local;
    summary.has_scans |= event->channel == channels.scan || event->channel == channels.range_image;
    summary.has_detections |= event->channel == channels.detections;
  }
  summary.has_lines = has_laser && has_poses;
  summary.error = log.error();
  return summary;
}

// The way of a log's messages into the history, once through the log.
class LogPlayer::Stage {
 public:
  Stage(const LogPlayerOptions& options, const LogSummary& log, ScanDetector* detector,
        ScanHistory* history)
      : channels_(options.channels),
        detector_(log.has_detections ? nullptr : detector),
        history_(history),
        feed_(options.channels, options.configuration.bus, history) {
    // Scans that nobody looked at can only be looked at as lines: what the log's own scans are
    // made of.
    if (log.has_lines && (!log.has_scans || detector_ != nullptr))
      assembler_.emplace(options.configuration.pipeline.sweep);
  }

  // True when it showed all that there is of a scan.
  bool Take(const LogEvent& event) {
    if (assembler_ && event.channel == channels_.laser) return TakeLine(event);
    if (assembler_ && event.channel == channels_.laser_to_local) return TakePose(event);
    if (assembler_ && (event.channel == channels_.scan || event.channel == channels_.range_image))
      return false;
    const SceneFeed::Time now{std::chrono::microseconds(event.utime)};
    const TakenMessage taken =
        feed_.Take(event.channel, event.bytes.data(), event.bytes.size(), now);
    if (!taken.error.empty()) Complain(event.channel + ": " + taken.error);
    return taken.has_detections;
  }

  bool Finish() { return assembler_ && Show(assembler_->Finish()); }
  // What could not be used; empty when all could.
  std::string warning() const {
    return num_unusable_ == 0 ? ""
                              : std::to_string(num_unusable_) +
                                    " messages could not be used, the first on " + first_unusable_;
  }

 private:
  bool TakeLine(const LogEvent& event) {
    const Decoded<bot_core::planar_lidar_t> decoded =
        DecodeMessage<bot_core::planar_lidar_t>(event.bytes.data(), event.bytes.size());
    LaserLineFromMessage line;
    if (decoded.message) line = FromMessage(*decoded.message);
    if (line.line) return Show(assembler_->AddLine(std::move(*line.line)));
    Complain(event.channel + ": " + decoded.error + line.error);
    return false;
  }
  bool TakePose(const LogEvent& event) {
    const Decoded<bot_core::rigid_transform_t> decoded =
        DecodeMessage<bot_core::rigid_transform_t>(event.bytes.data(), event.bytes.size());
    TimedPoseFromMessage pose;
    if (decoded.message) pose = FromMessage(*decoded.message);
    if (pose.pose) return Show(assembler_->AddPose(*pose.pose));
    Complain(event.channel + ": " + decoded.error + pose.error);
    return false;
  }
  bool Show(const std::vector<Sweep>& sweeps) {
    bool shown = false;
    for (const Sweep& sweep : sweeps) {
      if (!sweep.complete()) {
        Complain("an incomplete sweep: " + sweep.incomplete_reason);
        continue;
      }
      history_->SetScan(sweep.begin.count(), sweep.scan);
      if (detector_ != nullptr) detector_->Detect(sweep.begin.count(), sweep.scan, history_);
      shown = true;
    }
    return shown;
  }
  void Complain(const std::string& cause) {
    if (num_unusable_++ == 0) first_unusable_ = cause;
  }

  const Channels& channels_;
  ScanDetector* detector_;
  ScanHistory* history_;
  SceneFeed feed_;
  std::optional<SweepAssembler> assembler_;
  std::int64_t num_unusable_ = 0;
  std::string first_unusable_;
};

LogPlayer::LogPlayer(const LogPlayerOptions& options, const LogSummary& log,
                     std::unique_ptr<ScanDetector> detector, WebContent* content)
    : options_(options), log_(log), detector_(std::move(detector)), content_(content) {
  playback_.playing = true;
  playback_.speed = options.speed;
  playback_.duration = SecondsFrom(log.begin, log.end);
  playback_.warning = log.error;
  thread_ = std::thread([this] { Run(); });
}

LogPlayer::~LogPlayer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LogPlayer::Take(const ClientRequest& request) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Anchor();
    switch (request.command) {
      case PlayerCommand::kPlay:
        restart_ |= playback_.at_end;
        playback_.playing = true;
        stepping_ = false;
        break;
      case PlayerCommand::kPause:
        playback_.playing = false;
        stepping_ = false;
        break;
      case PlayerCommand::kStep:
        restart_ |= playback_.at_end;
        playback_.playing = true;
        stepping_ = true;
        break;
      case PlayerCommand::kRestart:
        restart_ = true;
        playback_.playing = true;
        stepping_ = false;
        break;
      case PlayerCommand::kSpeed:
        playback_.speed = request.speed;
        break;
    }
    next_tell_ = {};
  }
  changed_.notify_all();
}

void LogPlayer::Run() {
  while (true) {
    try {
      PlayOnce();
    } catch (const std::exception& error) {
      spdlog::error("{}: {}", options_.path, error.what());
      const std::lock_guard<std::mutex> lock(mutex_);
      playback_.warning = error.what();
      playback_.playing = false;
      playback_.at_end = true;
    }
    Rest();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stop_) return;
  }
}

void LogPlayer::PlayOnce() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    restart_ = false;
    playback_.at_end = false;
    playback_.position = 0.0;
    next_tell_ = {};
    Anchor();
  }
  EventLogReader log(options_.path);
  Stage stage(options_, log_, detector_.get(), &content_->scans());
  const auto note = [&](bool shown) {
    const std::string warning = log_.error.empty() ? stage.warning() : log_.error;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (warning != playback_.warning) next_tell_ = {};
    playback_.warning = warning;
    if (!shown || !stepping_) return;
    stepping_ = playback_.playing = false;
    next_tell_ = {};
  };
  while (const std::optional<LogEvent> event = log.Next()) {
    if (!WaitFor(SecondsFrom(log_.begin, event->utime))) return;
    note(stage.Take(*event));
  }
  note(stage.Finish());
  const std::lock_guard<std::mutex> lock(mutex_);
  playback_.at_end = true;
  playback_.playing = stepping_ = false;
  playback_.position = playback_.duration;
}

bool LogPlayer::WaitFor(double position) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_ && !restart_) {
    if (Clock::now() >= next_tell_) {
      Tell(&lock);
      continue;
    }
    if (!playback_.playing) {
      changed_.wait(lock);
      continue;
    }
    if (position - playback_.position > kLongestSilence) {
      playback_.position = position;
      Anchor();
    }
    if (stepping_ || Clock::now() >= DueTime(position)) {
      playback_.position = std::max(position, playback_.position);
      if (stepping_) Anchor();
      return true;
    }
    changed_.wait_until(lock, std::min(DueTime(position), next_tell_));
  }
  return false;
}

void LogPlayer::Rest() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_ && !restart_) {
    Tell(&lock);
    if (!stop_ && !restart_) changed_.wait(lock);
  }
}

void LogPlayer::Anchor() {
  anchor_position_ = playback_.position;
  anchor_time_ = Clock::now();
}

LogPlayer::Clock::time_point LogPlayer::DueTime(double position) const {
  const double seconds = std::max(position - anchor_position_, 0.0) / playback_.speed;
  const std::chrono::duration<double> wait(seconds);
  return anchor_time_ + std::chrono::duration_cast<Clock::duration>(wait);
}

void LogPlayer::Tell(std::unique_lock<std::mutex>* lock) {
  next_tell_ = Clock::now() + kTellPeriod;
  const Playback playback = playback_;
  lock->unlock();
  content_->SetPlayback(playback);
  lock->lock();
}

}  // namespace rimod
