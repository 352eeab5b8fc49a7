#include "tools/whit/help_topics.h"

#include <set>

#include "core/check/findings.h"
#include "core/check/names.h"
#include "core/plugin/registry.h"
#include "core/render/aovs.h"
#include "parser/statements.h"
#include "tools/whit/commands.h"
#include "tools/whit/help_text.h"
#include "tools/whit/plugin_statements.h"

namespace whit {
namespace {

TopicGroup commands_group() {
  TopicGroup group{"command", {"commands"}, {"whit"}, {}, true};
  for (const Command& c : commands()) group.topics.push_back({c.name, {}, [&c] { c.run({"--help"}); }});
  return group;
}

TopicGroup statements_group() {
  TopicGroup group{"statement", {"statements", "directive", "directives"}, {}, {}, false};
  for (const StatementRow& s : statements()) group.topics.push_back({std::string(s.name), {}, [&s] { print_help(s); }});
  return group;
}

TopicGroup effects_group() {
  TopicGroup group{"effect", {"effects"}, {}, {}, false};
  for_effects(EffectSet::all(), [&](Effect e) {
    group.topics.push_back({effect_info(e).name, {}, [e] { print_help(e); }});
  });
  return group;
}

TopicGroup aovs_group() {
  TopicGroup group{"AOV", {"aov", "aovs"}, {}, {}, false};
  for (const AovRow& row : all_aovs()) group.topics.push_back({row.name, {}, [&row] { print_help(row); }});
  return group;
}

/// What `whit check` finds, by the names that silence it.
TopicGroup findings_group() {
  TopicGroup group{"finding", {"findings"}, {}, {}, false};
  const auto add = [&group](const char* name, const char* what) {
    group.topics.push_back({name, {}, [name, what] { print_help_of_finding(name, what); }});
  };
  for (const FindingKind& k : finding_kinds()) add(k.name, k.what);
  for (const NamedWarning& w : named_warnings()) add(w.name, w.what);
  return group;
}

/// The plugins of a category. Both kinds of textures also answer to "texture".
TopicGroup plugins_group(const std::string& category) {
  TopicGroup group{category, {category + "s"}, {}, {}, true};
  const PluginStatement* statement = statement_of(category);
  if (statement) group.before = {statement->statement};
  if (category.ends_with(" texture")) group.others.insert(group.others.end(), {"texture", "textures"});
  for (const PluginInfo* p : list_plugins(category))
    group.topics.push_back({p->name, p->aliases, [p] { print_help(*p); }});
  return group;
}

}  // namespace

std::vector<TopicGroup> topic_groups() {
  std::vector<TopicGroup> groups{commands_group(), statements_group()};
  std::set<std::string> categories;
  for (const PluginInfo* p : list_plugins()) categories.insert(p->category);
  for (const std::string& category : categories) groups.push_back(plugins_group(category));
  groups.push_back(effects_group());
  groups.push_back(aovs_group());
  groups.push_back(findings_group());
  return groups;
}

}  // namespace whit
