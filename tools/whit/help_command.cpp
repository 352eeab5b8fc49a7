// `whit help`: commands, plugins, statements, effects and AOVs, from the same tables that run and parse them.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <set>

#include "core/base/diagnostics.h"
#include "core/base/plain_text.h"
#include "tools/whit/command_line.h"
#include "tools/whit/completion.h"
#include "tools/whit/help_json.h"
#include "tools/whit/help_text.h"
#include "tools/whit/help_topics.h"
#include "tools/whit/manual_page.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

using Names = std::vector<std::string>;
using SameName = std::function<bool(const std::string&, const std::string&)>;

bool is_in(const Names& names, const std::string& name, const SameName& same) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& n) { return same(n, name); });
}

/// What may stand before the name of something in a group.
bool is_kind(const TopicGroup& group, const std::string& words, const SameName& same) {
  return same(group.name, words) || is_in(group.others, words, same) || is_in(group.before, words, same);
}

/// What was asked for: the words before the last as the kind of thing, "" for any, and the last.
struct Question {
  std::string kind, name;
  std::string all() const { return kind.empty() ? name : fmt::format("{} {}", kind, name); }
};

Question question_of(const Arguments& args) {
  const std::string words = fmt::format("{}", fmt::join(args, " "));
  const size_t last = words.rfind(' ');
  if (last == std::string::npos) return {"", words};
  return {words.substr(0, last), words.substr(last + 1)};
}

/// Prints one thing after another, those of a group that wants it with an empty line between.
class Printer {
 public:
  void print(const TopicGroup& group, const Topic& topic) {
    if (last_ && (group.spaced || last_ != &group)) fmt::print("\n");
    last_ = &group;
    std::fflush(stdout);
    topic.print();
  }
  bool printed() const { return last_ != nullptr; }

 private:
  const TopicGroup* last_ = nullptr;
};

/// Prints everything that the question names.
bool answer(const std::vector<TopicGroup>& groups, const Question& asked, const SameName& same) {
  Printer printer;
  for (const TopicGroup& group : groups) {
    const bool whole = same(group.name, asked.all()) || is_in(group.others, asked.all(), same);
    const bool kind = asked.kind.empty() || is_kind(group, asked.kind, same);
    for (const Topic& topic : group.topics) {
      if (whole || (kind && (same(topic.name, asked.name) || is_in(topic.aliases, asked.name, same))))
        printer.print(group, topic);
    }
  }
  return printer.printed();
}

bool same_letters(const std::string& a, const std::string& b) { return lower_case(a) == lower_case(b); }

/// What there is no answer to, and what was probably meant.
std::string no_answer(const std::vector<TopicGroup>& groups, const Question& asked) {
  Names kinds, of_kind, anything;
  std::set<std::string> elsewhere;
  for (const TopicGroup& group : groups) {
    kinds.push_back(group.name);
    kinds.insert(kinds.end(), group.others.begin(), group.others.end());
    const bool kind = is_kind(group, asked.kind, same_letters);
    for (const Topic& topic : group.topics) {
      anything.push_back(topic.name);
      if (kind) of_kind.push_back(topic.name);
      if (same_letters(topic.name, asked.name)) elsewhere.insert(fmt::format("{} \"{}\"", group.name, topic.name));
    }
  }
  anything.insert(anything.end(), kinds.begin(), kinds.end());
  const auto remedy = [](const std::string& hint) { return hint.empty() ? "`whit help` lists what there is" : hint; };
  if (asked.kind.empty())
    return fmt::format("there is nothing called \"{}\"; {}", asked.name, remedy(did_you_mean(asked.name, anything)));
  if (of_kind.empty())
    return fmt::format("there is no kind of things called \"{}\"; {}", asked.kind,
                       remedy(did_you_mean(asked.kind, kinds)));
  if (!elsewhere.empty())
    return fmt::format("there is no {} \"{}\", but {}", asked.kind, asked.name, fmt::join(elsewhere, " and "));
  return fmt::format("there is no {} \"{}\"; {}", asked.kind, asked.name, remedy(did_you_mean(asked.name, of_kind)));
}

int explain(const Arguments& words) {
  if (words.empty() || words == Arguments{"help"}) {
    print_overview();
    return kDone;
  }
  const std::vector<TopicGroup> groups = topic_groups();
  const Question asked = question_of(words);
  if (answer(groups, asked, std::equal_to<std::string>()) || answer(groups, asked, same_letters)) return kDone;
  say("whit help: " + no_answer(groups, asked));
  return kUsage;
}

/// For completion: the names of everything that is one word.
std::vector<std::string> topic_names() {
  std::set<std::string> names;
  for (const TopicGroup& group : topic_groups()) {
    names.insert(group.name.substr(group.name.rfind(' ') + 1));
    for (const Topic& topic : group.topics) names.insert(topic.name);
  }
  return {names.begin(), names.end()};
}

}  // namespace

int help_command(const Arguments& args) {
  Arguments words;
  bool as_json = false, as_manual = false;
  std::string shell;
  const CommandLine command{
      "whit help",
      "Explains a command, plugin, statement, effect or AOV by its name, or lists what there is.",
      {{"name", &words, "What to explain, alone or behind its kind: shape sphere", {.offers = topic_names}},
       {"--json", &as_json, "Print all that can stand in a scene file as JSON", {}},
       {"--completion", &shell, "Print a script with which a shell completes commands", {.choices = shells()}},
       {"--man", &as_manual, "Print the manual page, for man", {.excludes = "--completion"}}}};
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  if (as_json || as_manual || !shell.empty()) {
    fmt::print("{}", as_json ? help_json() + "\n" : as_manual ? manual_page() : completion_script(shell));
    return kDone;
  }
  return explain(words);
}

}  // namespace whit
