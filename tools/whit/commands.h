// The commands of `whit`. Each takes the arguments behind its name and returns the exit code:
// 0 done; 1 the answer is no; 2 wrong usage; 3 the scene is wrong; 4 input or output failed; 5 a limit was hit.
#pragma once

#include <string>
#include <vector>

namespace whit {

using Arguments = std::vector<std::string>;

inline constexpr int kDone = 0, kNo = 1, kUsage = 2, kSceneError = 3, kFileError = 4, kLimit = 5;

int render_command(const Arguments& args);   ///< whit [render] SCENE...
int check_command(const Arguments& args);    ///< whit check SCENE...
int fmt_command(const Arguments& args);      ///< whit fmt SCENE
int watch_command(const Arguments& args);    ///< whit watch SCENE
int lsp_command(const Arguments& args);      ///< whit lsp
int explain_command(const Arguments& args);  ///< whit explain SCENE
int cost_command(const Arguments& args);     ///< whit cost SCENE
int import_command(const Arguments& args);   ///< whit import MODEL -o SCENE
int merge_command(const Arguments& args);    ///< whit merge PARTS... -o PICTURE
int diff_command(const Arguments& args);     ///< whit diff A B
int bench_command(const Arguments& args);    ///< whit bench [SCENES...]
int help_command(const Arguments& args);     ///< whit help [[KIND] NAME | --json]

/// A command's name, its function and one line of what it does: the table behind dispatch and help.
struct Command {
  const char* name;
  int (*run)(const Arguments&);
  const char* synopsis;
  const char* summary;
};
const std::vector<Command>& commands();

}  // namespace whit
