#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "web_viewer/client_request.h"
#include "web_viewer/web_content.h"

namespace rimod {

// One page's side of the conversation. A frame goes out only when the page has shown the one
// before, and what goes out is chosen at that moment: a slow page gets fewer frames, none of them
// stale, and nothing queues up for it.
class ClientSession {
 public:
  explicit ClientSession(const WebContent* content) : content_(content) {}

  // What the page asks for; commands to the player are not its business.
  void Take(const ClientRequest& request);

  // The next frame that the page does not have; nothing when it has all, or has not shown the last
  // one. Kinds take turns: scans that come fast do not keep the others back.
  std::optional<Frame> Next();

 private:
  enum Kind : std::size_t { kScan, kObjects, kTimeline, kPlayback, kModel, kNumKinds };

  Frame NextOf(Kind kind);
  Frame NextPart(Kind kind, const ScanHistory::Part& part);

  const WebContent* content_;
  bool under_way_ = false;  // a frame that is not shown yet
  bool greeted_ = false;
  std::optional<std::int64_t> chosen_;                                // id; none: the newest
  std::array<std::int64_t, kNumKinds> versions_{-1, -1, -1, -1, -1};  // as last sent
  std::set<std::string> wanted_models_;  // that are known, not sent yet
  std::size_t next_kind_ = kScan;
};

}  // namespace rimod
