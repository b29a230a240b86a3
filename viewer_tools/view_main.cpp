#include "viewer_tools/view_command.h"
#include "viewer_tools/view_options.h"

int main(int argc, char** argv) {
  const rimod::ViewOptionsResult result = rimod::ParseViewOptions(argc, argv);
  return result.options ? rimod::RunView(*result.options) : result.exit_code;
}
