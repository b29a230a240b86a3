#pragma once

#include <string>
#include <vector>

namespace rimod {

// Whom the server answers. A page of somebody else's in the user's browser can send requests to
// 127.0.0.1, too, but the browser tells whom it believes to talk to (Host) and whose page it is
// (Origin).

// True when the host named in a Host header ("name", "name:port", "[::1]:port") is the machine
// itself (localhost, 127.0.0.1, [::1]) or one of the further names; case does not matter. Any port:
// the user may have forwarded it.
bool IsAllowedHost(const std::string& host, const std::vector<std::string>& further_names);

// True when an Origin header ("http://name:port") names exactly the host of the Host header.
bool IsSameOrigin(const std::string& origin, const std::string& host);

}  // namespace rimod
