#include "web_viewer/client_request.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "rimod/object_model.h"

namespace rimod {
namespace {

using Json = nlohmann::json;
using Kind = ClientRequest::Kind;

constexpr double kMinSpeed = 0.01;

std::optional<ClientRequest> Player(PlayerCommand command, double speed = 1.0) {
  ClientRequest request;
  request.kind = Kind::kPlayer;
  request.command = command;
  request.speed = speed;
  return request;
}

std::optional<ClientRequest> ParseSpeed(const Json& json) {
  const auto factor = json.find("factor");
  if (factor == json.end() || !factor->is_number()) return std::nullopt;
  const double speed = factor->get<double>();
  if (!(speed >= kMinSpeed && speed <= kMaxSpeed)) return std::nullopt;
  return Player(PlayerCommand::kSpeed, speed);
}

std::optional<ClientRequest> ParseChoose(const Json& json) {
  const auto id = json.find("id");
  if (id == json.end() || !id->is_number_integer()) return std::nullopt;
  ClientRequest request;
  request.kind = Kind::kChoose;
  request.id = id->get<std::int64_t>();
  return request;
}

std::optional<ClientRequest> ParseModel(const Json& json) {
  const auto name = json.find("name");
  if (name == json.end() || !name->is_string()) return std::nullopt;
  ClientRequest request;
  request.kind = Kind::kModel;
  request.name = name->get<std::string>();
  if (!IsValidModelName(request.name)) return std::nullopt;
  return request;
}

std::optional<ClientRequest> OfKind(Kind kind) {
  ClientRequest request;
  request.kind = kind;
  return request;
}

}  // namespace

std::optional<ClientRequest> ParseClientRequest(const std::string& text) {
  if (text.size() > kMaxRequestBytes) return std::nullopt;
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return std::nullopt;
  const auto found = json.find("type");
  if (found == json.end() || !found->is_string()) return std::nullopt;
  const std::string type = found->get<std::string>();
  if (type == "shown") return OfKind(Kind::kShown);
  if (type == "follow") return OfKind(Kind::kFollow);
  if (type == "choose") return ParseChoose(json);
  if (type == "model") return ParseModel(json);
  if (type == "play") return Player(PlayerCommand::kPlay);
  if (type == "pause") return Player(PlayerCommand::kPause);
  if (type == "step") return Player(PlayerCommand::kStep);
  if (type == "restart") return Player(PlayerCommand::kRestart);
  if (type == "speed") return ParseSpeed(json);
  return std::nullopt;
}

bool RequestBudget::Take(Time now) {
  if (last_) {
    const std::chrono::duration<double> elapsed = now - *last_;
    left_ = std::min(kInARow, left_ + kPerSecond * elapsed.count());
  }
  last_ = now;
  if (left_ < 1.0) return false;
  left_ -= 1.0;
  return true;
}

}  // namespace rimod
