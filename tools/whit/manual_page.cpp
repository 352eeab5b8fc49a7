#include "tools/whit/manual_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/base/effect.h"
#include "core/render/aovs.h"
#include "tools/whit/command_line.h"
#include "tools/whit/version.h"

namespace whit {
namespace {

/// Text as troff prints it: its own signs escaped, also where they start a line.
std::string plain(std::string_view text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) out.append("\\&");
    if (c == '\\') out.append("\\e");
    else if (c == '-') out.append("\\-");
    else out.push_back(c);
    line_start = c == '\n';
  }
  return out;
}

/// The same as an argument of a request.
std::string argument(std::string_view text) {
  std::string out = plain(text);
  for (size_t at = 0; (at = out.find('"', at)) != std::string::npos; at += 2) out.insert(at, 1, '"');
  return fmt::format("\"{}\"", out);
}

std::string bold(std::string_view text) { return fmt::format("\\fB{}\\fR", plain(text)); }

/// Paragraphs as they are written: an empty line between, and lines that are indented on their own.
std::string paragraphs(const std::string& text) {
  std::string out;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    const size_t start = line.find_first_not_of(' ');
    if (start == std::string::npos) out.append(".PP\n");
    else out.append(start > 0 ? ".br\n" : "").append(plain(line.substr(start))).append("\n");
  }
  return out;
}

std::string describe_flag(const FlagDescription& flag) {
  std::string name;
  for (const std::string& n : flag.names) name.append(name.empty() ? "" : ", ").append(bold(n));
  if (!flag.value.empty()) name.append(name.empty() ? "" : " ").append(fmt::format("\\fI{}\\fR", plain(flag.value)));
  if (flag.count > 1) name.append(fmt::format(" (x{})", flag.count));
  std::string text = fmt::format(".TP\n{}\n{}\n", name, plain(flag.help));
  // Of many words --help does not speak either.
  if (!flag.words.empty() && flag.words.size() <= 40)
    text.append(fmt::format("({})\n", plain(fmt::format("{}", fmt::join(flag.words, ", ")))));
  return text;
}

std::string describe_commands() {
  std::string text = ".SH COMMANDS\nEach has\n.BR \\-\\-help .\n";
  for (const Command& c : commands()) {
    const CommandDescription command = describe(c);
    text.append(fmt::format(".SS {}\n{}", argument(fmt::format("whit {}", c.synopsis)), paragraphs(command.about)));
    for (const FlagDescription& flag : command.flags) text.append(describe_flag(flag));
  }
  return text;
}

std::string describe_effects() {
  std::string text = ".SH EFFECTS\nWhat a scene can call for, and\n.B \\-\\-without\nleaves out.\n";
  for_effects(EffectSet::all(), [&](Effect e) {
    const EffectInfo& info = effect_info(e);
    text.append(fmt::format(".TP\n{}\n{}\nWithout: {}\n", bold(info.name), plain(info.doc), plain(info.off)));
  });
  return text;
}

std::string describe_aovs() {
  std::string text = ".SH AOVS\nWhat\n.B \\-\\-aov\nadds to an OpenEXR file.\n";
  for (const AovRow& row : all_aovs()) text.append(fmt::format(".TP\n{}\n{}\n", bold(row.name), plain(row.doc)));
  return text;
}

constexpr std::string_view kDescription = R"(.SH DESCRIPTION
.B whit
renders scene files of pbrt\-v3 and glTF 2.0 models with a Whitted or path tracing integrator on Embree.
It simulates what the scene calls for, and nothing else.
Without a scene file it reads standard input.
Problems and progress go to standard error, results to standard output.
)";

constexpr std::string_view kEnd = R"(.SH "EXIT STATUS"
.TP
.B 0
Done.
.TP
.B 1
The answer is no: pictures differ, a check found something.
.TP
.B 2
Wrong usage.
.TP
.B 3
The scene is wrong.
.TP
.B 4
A file could not be read or written.
.TP
.B 5
A limit was hit: memory, time, or a signal. What there is was saved.
.SH ENVIRONMENT
.TP
.B OCIO
The OpenColorIO config, unless
.B \-\-ocio
names one.
.TP
.B NO_COLOR
When set, messages are not coloured.
.TP
.B TMPDIR
The folder of temporary files.
.SH EXAMPLES
.TP
.B whit scene.pbrt \-o picture.png
Renders a scene to a picture to look at.
.TP
.B whit scene.pbrt \-\-target\-error 1%
Renders until the error of the picture is below one percent.
.TP
.B whit help imagemap
Explains the texture of that name, and all its parameters.
)";

}  // namespace

std::string manual_page() {
  std::string text = fmt::format(".TH WHIT 1 \"\" {} \"User Commands\"\n", argument(fmt::format("whit {}", version())));
  text.append(".SH NAME\nwhit \\- render pbrt\\-v3 scenes and glTF models, and help to write them\n.SH SYNOPSIS\n");
  for (const Command& c : commands()) {
    text.append(&c == &commands().front() ? "" : ".br\n");
    text.append(fmt::format(".B whit\n{}\n", plain(c.synopsis)));
  }
  return text.append(kDescription)
      .append(describe_commands())
      .append(describe_effects())
      .append(describe_aovs())
      .append(kEnd);
}

}  // namespace whit
