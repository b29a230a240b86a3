#include "web_viewer/client_session.h"

namespace rimod {

void ClientSession::Take(const ClientRequest& request) {
  switch (request.kind) {
    case ClientRequest::Kind::kShown:
      under_way_ = false;
      break;
    case ClientRequest::Kind::kFollow:
      chosen_.reset();
      break;
    case ClientRequest::Kind::kChoose:
      if (content_->scans().Has(request.id)) chosen_ = request.id;
      break;
    case ClientRequest::Kind::kModel:
      if (content_->Model(request.name)) wanted_models_.insert(request.name);
      break;
    case ClientRequest::Kind::kPlayer:
      break;
  }
}

std::optional<Frame> ClientSession::Next() {
  if (under_way_) return std::nullopt;
  if (!greeted_) {
    greeted_ = true;
    under_way_ = true;
    return content_->hello();
  }
  if (chosen_ && !content_->scans().Has(*chosen_)) chosen_.reset();  // forgotten meanwhile
  for (std::size_t i = 0; i < kNumKinds; ++i) {
    const std::size_t kind = (next_kind_ + i) % kNumKinds;
    const Frame frame = NextOf(static_cast<Kind>(kind));
    if (!frame) continue;
    next_kind_ = (kind + 1) % kNumKinds;
    under_way_ = true;
    return frame;
  }
  return std::nullopt;
}

Frame ClientSession::NextOf(Kind kind) {
  switch (kind) {
    case kScan:
      return NextPart(kind, content_->scans().ScanPart(chosen_));
    case kObjects:
      return NextPart(kind, content_->scans().ObjectsPart(chosen_));
    case kTimeline:
      return NextPart(kind, content_->scans().TimelinePart());
    case kPlayback:
      return NextPart(kind, content_->PlaybackPart());
    case kModel:
    case kNumKinds:
      break;
  }
  if (wanted_models_.empty()) return nullptr;
  const std::string name = *wanted_models_.begin();
  wanted_models_.erase(wanted_models_.begin());
  return content_->Model(name);
}

Frame ClientSession::NextPart(Kind kind, const ScanHistory::Part& part) {
  if (!part.frame || part.version == versions_[kind]) return nullptr;
  versions_[kind] = part.version;
  return part.frame;
}

}  // namespace rimod
