#pragma once

namespace rimod {

// Starts this program anew inside a private network where LCM's default URL works among the
// processes started there and nothing leaves the machine. Returns in the new one only; exits with
// kSkipped where private networks are forbidden.
void EnterPrivateNetwork(char** argv);

// CTest's SKIP_RETURN_CODE of these tests: they did not run.
constexpr int kSkipped = 77;

}  // namespace rimod
