#pragma once

// For functions whose time goes into loops over plain arrays: compiled a second time for processors
// with eight lanes (AVX2), of which the one that fits is taken when the program starts. Without
// fused multiplication, so that the results are the same bits on all processors. Not with the
// sanitizers, which are not there yet when it is chosen, and not with RIMOD_FOUR_LANES (for
// comparing).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(RIMOD_FOUR_LANES)
#define RIMOD_HAS_WIDE_LOOPS
#define RIMOD_WIDE_LOOPS __attribute__((target_clones("avx2", "default")))
#else
#define RIMOD_WIDE_LOOPS
#endif

namespace rimod {

// Which of the two this processor takes.
inline bool LoopsHaveEightLanes() {
#ifdef RIMOD_HAS_WIDE_LOOPS
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace rimod
