#include "tools/whit/check_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/base/file_names.h"
#include "core/check/edit.h"
#include "core/check/findings.h"
#include "core/check/names.h"
#include "parser/lexer.h"
#include "tools/whit/json.h"
#include "tools/whit/version.h"

namespace whit {
namespace {

/// Where the token ends that a diagnostic points at, on the same line.
SourcePlace end_place(const Sources& sources, SourcePos where) {
  const std::string_view text = sources.text(where.file);
  if (where.offset >= text.size()) return sources.place(where);
  const std::string_view token = token_at(text, where.offset);
  const size_t length = std::min(token.find('\n'), token.size());
  return sources.place({where.file, where.offset + std::max<size_t>(length, 1)});
}

Json fix_of(const Sources& sources, const Diagnostic& d) {
  const std::optional<Edit> edit = edit_of(sources, d);
  if (!edit) return {};
  const SourcePlace begin = sources.place({edit->file, edit->begin}), end = sources.place({edit->file, edit->end});
  return Json::Object{{"line", begin.line},
                      {"column", begin.column},
                      {"endColumn", end.column},
                      {"written", d.slip.written},
                      {"meant", d.slip.meant}};
}

Json diagnostic_as_json(const Sources& sources, const Diagnostic& d) {
  const SourcePlace place = sources.place(d.where);
  Json::Object out{{"severity", severity_name(d.severity)},
                   {"name", d.name},
                   {"file", sources.name(d.where.file)},
                   {"line", place.line},
                   {"column", place.column},
                   {"endColumn", end_place(sources, d.where).column},
                   {"message", d.message},
                   {"hint", d.remedy}};
  if (Json fix = fix_of(sources, d); !std::holds_alternative<std::monostate>(fix.value))
    out.emplace_back("fix", std::move(fix));
  return out;
}

/// The path of a file as a URI: relative where the path is, with what URIs may not hold as %XX.
std::string uri_of(const std::string& path) { return (path.starts_with('/') ? "file://" : "") + percent_encoded(path); }

Json text_of(const std::string& text) { return Json::Object{{"text", text}}; }

Json location_of(const Sources& sources, SourcePos where) {
  const SourcePlace begin = sources.place(where), end = end_place(sources, where);
  Json::Object region{{"startLine", begin.line}, {"startColumn", begin.column}};
  if (end.line == begin.line) region.emplace_back("endColumn", end.column);
  return Json::Object{
      {"physicalLocation", Json::Object{{"artifactLocation", Json::Object{{"uri", uri_of(sources.name(where.file))}}},
                                        {"region", std::move(region)}}}};
}

Json sarif_fix(const Sources& sources, const Diagnostic& d, const Edit& edit) {
  const SourcePlace begin = sources.place({edit.file, edit.begin}), end = sources.place({edit.file, edit.end});
  const Json region = Json::Object{
      {"startLine", begin.line}, {"startColumn", begin.column}, {"endLine", end.line}, {"endColumn", end.column}};
  const Json replacement = Json::Object{{"deletedRegion", region}, {"insertedContent", text_of(edit.text)}};
  const Json change = Json::Object{{"artifactLocation", Json::Object{{"uri", uri_of(sources.name(edit.file))}}},
                                   {"replacements", Json::Array{replacement}}};
  return Json::Object{{"description", text_of(fmt::format("Write {} instead of {}", d.slip.meant, d.slip.written))},
                      {"artifactChanges", Json::Array{change}}};
}

struct Rule {
  std::string name, what;
  const char* level;
};

/// All names that a diagnostic can have.
std::vector<Rule> all_rules() {
  std::vector<Rule> rules = {{"mistake", "What the file says cannot be understood, or is wrong.", "error"},
                             {"file", "A file that the scene names cannot be read.", "error"}};
  for (const NamedWarning& w : named_warnings()) rules.push_back({w.name, w.what, "warning"});
  for (const FindingKind& k : finding_kinds()) rules.push_back({k.name, k.what, severity_name(k.severity)});
  return rules;
}

Json rule_as_json(const Rule& rule) {
  const bool fixed = std::string_view(rule.level) == "error";
  const std::string help = fixed ? rule.what + " It cannot be silenced."
                                 : fmt::format("{} Silence it with --allow {}, or with a comment \"# whit: allow {}\".",
                                               rule.what, rule.name, rule.name);
  return Json::Object{{"id", rule.name},
                      {"shortDescription", text_of(rule.what)},
                      {"help", text_of(help)},
                      {"defaultConfiguration", Json::Object{{"level", rule.level}}}};
}

Json result_as_json(const Sources& sources, const Diagnostic& d, size_t rule) {
  Json::Object out{{"ruleId", d.name},
                   {"ruleIndex", rule},
                   {"level", severity_name(d.severity)},
                   {"message", text_of(d.remedy.empty() ? d.message : d.message + "\n" + d.remedy)}};
  if (d.where.known()) out.emplace_back("locations", Json::Array{location_of(sources, d.where)});
  if (d.other.known()) out.emplace_back("relatedLocations", Json::Array{location_of(sources, d.other)});
  if (const std::optional<Edit> edit = edit_of(sources, d))
    out.emplace_back("fixes", Json::Array{sarif_fix(sources, d, *edit)});
  return out;
}

}  // namespace

std::string check_as_json(const std::vector<Checked>& all) {
  Json::Array diagnostics;
  int counts[3] = {};
  for (const Checked& checked : all) {
    for (const Diagnostic& d : checked.found.all()) {
      diagnostics.push_back(diagnostic_as_json(*checked.sources, d));
      ++counts[static_cast<size_t>(d.severity)];
    }
  }
  return to_text(Json::Object{{"diagnostics", std::move(diagnostics)},
                              {"errors", counts[static_cast<size_t>(Severity::Error)]},
                              {"warnings", counts[static_cast<size_t>(Severity::Warning)]},
                              {"notes", counts[static_cast<size_t>(Severity::Note)]}});
}

std::string check_as_sarif(const std::vector<Checked>& all) {
  const std::vector<Rule> rules = all_rules();
  Json::Array rules_as_json, results;
  for (const Rule& rule : rules) rules_as_json.push_back(rule_as_json(rule));
  for (const Checked& checked : all) {
    for (const Diagnostic& d : checked.found.all()) {
      const auto rule = std::find_if(rules.begin(), rules.end(), [&](const Rule& r) { return r.name == d.name; });
      results.push_back(result_as_json(*checked.sources, d, static_cast<size_t>(rule - rules.begin())));
    }
  }
  const Json driver = Json::Object{{"name", "whit"}, {"version", version()}, {"rules", std::move(rules_as_json)}};
  const Json run = Json::Object{
      {"tool", Json::Object{{"driver", driver}}}, {"columnKind", "unicodeCodePoints"}, {"results", std::move(results)}};
  return to_text(Json::Object{
      {"$schema", "https://json.schemastore.org/sarif-2.1.0.json"}, {"version", "2.1.0"}, {"runs", Json::Array{run}}});
}

}  // namespace whit
