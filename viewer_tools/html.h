#pragma once

#include <string>

namespace rimod {

// Text as it may stand in HTML, also inside quoted attributes: & < > " ' as entities, control
// characters and what is not UTF-8 as '?'. Line ends and tabs stay.
std::string EscapeHtml(const std::string& text);

// "data:image/png;base64,...": bytes as a link that needs no file.
std::string DataUri(const std::string& media_type, const std::string& bytes);

}  // namespace rimod
