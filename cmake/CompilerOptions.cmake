# rimod_compiler_options(TARGET): language level, warnings and sanitizers of one target of ours.
function(rimod_compiler_options target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  # No contraction of a*b+c: results must not depend on the processor the compiler aims at. Nobody
  # reads errno or floating-point exceptions after mathematics: loops with roots can be vectorised.
  target_compile_options(
    ${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                      -ffp-contract=off -fno-math-errno -fno-trapping-math
                      $<$<BOOL:${RIMOD_WARNINGS_AS_ERRORS}>:-Werror>)
  if(RIMOD_SANITIZER STREQUAL "address-undefined")
    # Without what is checked at every access through a pointer (null, aligned, of the right size and
    # class): it trebles the time to compile. The address sanitizer stops at null and at memory that
    # is not an object's; the fuzzers' readers are checked for all of it.
    set(flags -fsanitize=address,undefined -fno-sanitize=null,alignment,object-size,vptr
              -fno-sanitize-recover=all -fno-omit-frame-pointer)
  elseif(RIMOD_SANITIZER STREQUAL "thread")
    set(flags -fsanitize=thread -fno-omit-frame-pointer)
  elseif(RIMOD_SANITIZER STREQUAL "fuzzer")
    set(flags -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -g1)
  elseif(RIMOD_SANITIZER)
    message(FATAL_ERROR "RIMOD_SANITIZER is '${RIMOD_SANITIZER}', not address-undefined, thread or fuzzer")
  endif()
  target_compile_options(${target} PUBLIC ${flags})
  target_link_options(${target} PUBLIC ${flags})
endfunction()
