#include "web_viewer/request_rules.h"

#include <algorithm>
#include <cctype>

namespace rimod {
namespace {

std::string Lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool IsPort(const std::string& text) {
  constexpr std::size_t kMaxDigits = 5;
  return !text.empty() && text.size() <= kMaxDigits &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

// The name before the port; empty where this is no host.
std::string NameOf(const std::string& host) {
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.find(':', bracket == std::string::npos ? 0 : bracket);
  if (colon == std::string::npos) return host;
  return IsPort(host.substr(colon + 1)) ? host.substr(0, colon) : "";
}

// "http://name:80" and "http://name" are the same.
std::string WithoutPort(const std::string& host, const std::string& port) {
  const bool has_it =
      host.size() > port.size() && host.compare(host.size() - port.size(), port.size(), port) == 0;
  return has_it ? host.substr(0, host.size() - port.size()) : host;
}

bool IsOrigin(const std::string& origin, const std::string& scheme, const std::string& port,
              const std::string& host) {
  if (origin.compare(0, scheme.size(), scheme) != 0) return false;
  return WithoutPort(origin.substr(scheme.size()), port) == WithoutPort(host, port);
}

}  // namespace

bool IsAllowedHost(const std::string& host, const std::vector<std::string>& further_names) {
  const std::string name = Lowered(NameOf(host));
  if (name == "localhost" || name == "127.0.0.1" || name == "[::1]") return true;
  return !name.empty() &&
         std::any_of(further_names.begin(), further_names.end(),
                     [&](const std::string& further) { return Lowered(further) == name; });
}

bool IsSameOrigin(const std::string& origin, const std::string& host) {
  const std::string lowered = Lowered(origin);
  const std::string lowered_host = Lowered(host);
  if (lowered_host.empty()) return false;
  return IsOrigin(lowered, "http://", ":80", lowered_host) ||
         IsOrigin(lowered, "https://", ":443", lowered_host);
}

}  // namespace rimod
