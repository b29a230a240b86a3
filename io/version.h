#pragma once

namespace rimod {

// The project's version, with the commit where it was built from a checkout.
const char* Version();

}  // namespace rimod
