# Runs page/build.sh. Without npm, or without the registry the first time, the page is left out, which
# is said, and everything else is built: the command succeeds, its output is missing.
#   cmake -D SCRIPT=build.sh -D WORK=DIR -D OUT=DIR -P build_page.cmake
execute_process(COMMAND "${SCRIPT}" "${WORK}" "${OUT}" RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  file(REMOVE "${OUT}/index.html")
  message("\n"
          "  rimod-web's page was NOT built: see above. rimod-web will not start and its page is not\n"
          "  tested; everything else is complete. It needs npm (./setup.sh --web) and once the npm\n"
          "  registry; then build again.\n")
endif()
