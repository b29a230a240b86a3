#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace rimod {

// What a log player is told to do.
enum class PlayerCommand { kPlay, kPause, kStep, kRestart, kSpeed };

// A message of a page.
struct ClientRequest {
  enum class Kind {
    kShown,   // the last frame is shown: the next may come
    kFollow,  // shows the newest scan, whenever one comes
    kChoose,  // shows one scan of the timeline
    kModel,   // wants the surface of a model
    kPlayer   // moves the log
  };
  Kind kind = Kind::kShown;
  std::int64_t id = 0;                           // kChoose
  std::string name;                              // kModel
  PlayerCommand command = PlayerCommand::kPlay;  // kPlayer
  double speed = 1.0;                            // kSpeed: times as fast as recorded
};

constexpr std::size_t kMaxRequestBytes = 1000;
constexpr double kMaxSpeed = 100.0;

// Reads a page's message, JSON such as {"type":"choose","id":5}. Nothing for whatever is none.
std::optional<ClientRequest> ParseClientRequest(const std::string& text);

// Lets through so many requests in a row, and so many a second.
class RequestBudget {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr double kPerSecond = 200.0;
  static constexpr double kInARow = 400.0;

  // False when there are too many.
  bool Take(Time now);

 private:
  double left_ = kInARow;
  std::optional<Time> last_;
};

}  // namespace rimod
