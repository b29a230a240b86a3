# RIMOD_VERSION_STRING: the project's version, plus the commit where the sources are a checkout.
set(RIMOD_VERSION_STRING "${PROJECT_VERSION}")
find_package(Git QUIET)
if(Git_FOUND)
  execute_process(
    COMMAND "${GIT_EXECUTABLE}" rev-parse --short HEAD
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
    OUTPUT_VARIABLE commit
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(commit)
    string(APPEND RIMOD_VERSION_STRING "+${commit}")
  endif()
endif()
