#include "io/version.h"

namespace rimod {

const char* Version() { return RIMOD_VERSION_STRING; }

}  // namespace rimod
