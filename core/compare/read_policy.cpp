// Reading a policy: from JSON to rules, each mistake with its place.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/diagnostics.h"
#include "core/base/limits.h"
#include "core/base/mapped_file.h"
#include "core/base/plain_text.h"
#include "core/color/to_linear.h"
#include "core/compare/measures.h"
#include "core/compare/policy.h"

namespace whit {
namespace {

using Json = nlohmann::json;

constexpr size_t kMostMistakes = 20;
constexpr const char* kSwitchedOff = "off";

/// The mistakes of one file, a line each.
class Mistakes {
 public:
  explicit Mistakes(std::string file) : file_(std::move(file)) {}

  void add(const std::string& place, const std::string& message, const std::string& remedy = {}) {
    if (++count_ > kMostMistakes) return;
    text_ += fmt::format("{}{}: {}{}{}{}", text_.empty() ? "" : "\n", file_, place.empty() ? "" : place + ": ", message,
                         remedy.empty() ? "" : "; ", remedy);
  }
  std::string text() const {
    return count_ <= kMostMistakes ? text_ : text_ + fmt::format("\n{}: and {} more", file_, count_ - kMostMistakes);
  }
  bool any() const { return count_ > 0; }

 private:
  std::string file_, text_;
  size_t count_ = 0;
};

/// Text of the file in a message: in quotes, short, and nothing in it that a terminal obeys.
std::string quoted(std::string text) {
  constexpr size_t kMost = 60;
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  return '"' + text + '"';
}

/// A key as a part of a JSON pointer.
std::string step(const std::string& key) {
  std::string out = "/";
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

/// What stands there, for a message.
std::string described(const Json& value) {
  if (value.is_string()) return quoted(value.get<std::string>());
  if (value.is_boolean() || value.is_number()) return value.dump();
  return value.is_object() ? "an object" : value.is_array() ? "an array" : "null";
}

/// Finds keys that an object has twice, of which the parser would keep the last one, while it parses.
class TwiceFinder {
 public:
  explicit TwiceFinder(Mistakes& mistakes) : mistakes_(mistakes) {}

  bool operator()(Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    if (event == Event::key) {
      level_.back().key = parsed.get<std::string>();
      if (!level_.back().seen.insert(level_.back().key).second) mistakes_.add(place(), "is there twice", "keep one");
    }
    if (event == Event::object_end || event == Event::array_end) level_.pop_back();
    const bool starts = event == Event::object_start || event == Event::array_start;
    if ((starts || event == Event::value) && !level_.empty()) ++level_.back().count;
    if (starts) level_.push_back({event == Event::array_start, 0, {}, {}});
    return true;
  }

 private:
  struct Level {
    bool array;
    size_t count;
    std::string key;
    std::set<std::string> seen;
  };
  std::string place() const {
    std::string out;
    for (const Level& l : level_) out += l.array ? fmt::format("/{}", l.count - 1) : step(l.key);
    return out;
  }

  Mistakes& mistakes_;
  std::vector<Level> level_;
};

/// What somebody may have meant who wrote this character where JSON has none such.
std::string syntax_remedy(char c) {
  if (c == 'N' || c == 'I' || c == 'a') return "numbers are finite; \"off\" switches a limit off";
  if (c == '/' || c == '#') return "remarks are texts under \"comment\"";
  if (c == '}' || c == ']') return "no comma comes before a closing bracket";
  return "";
}

Json parse(std::string_view text, Mistakes& mistakes) {
  TwiceFinder twice(mistakes);
  try {
    return Json::parse(text.begin(), text.end(),
                       [&](int, Json::parse_event_t event, Json& parsed) { return twice(event, parsed); });
  } catch (const Json::out_of_range& e) {
    mistakes.add("", json_message(e.what()), "write a number that a double holds");
  } catch (const Json::parse_error& e) {
    const bool inside = e.byte > 0 && e.byte <= text.size();
    mistakes.add("", "it is not JSON: " + json_message(e.what()), inside ? syntax_remedy(text[e.byte - 1]) : "");
  }
  return nullptr;
}

/// A value of a rule on its way into the settings.
class Value {
 public:
  Value(const Json& json, std::string place, Mistakes& mistakes)
      : json_(json), place_(std::move(place)), mistakes_(mistakes) {}

  void wrong(const std::string& message, const std::string& remedy = {}) const {
    mistakes_.add(place_, message, remedy);
  }
  void wrong_type(const std::string& wanted) const { wrong(fmt::format("{} is not {}", described(json_), wanted)); }

  void truth(std::optional<bool>& out) const {
    if (!json_.is_boolean()) return wrong_type("true or false");
    out = json_.get<bool>();
  }
  void text(std::optional<std::string>& out, const char* wanted) const {
    if (!json_.is_string() || json_.get<std::string>().empty()) return wrong_type(wanted);
    out = json_.get<std::string>();
  }
  void colour_space(std::optional<std::string>& out) const {
    text(out, "the name of a colour space");
    if (const std::string problem = out ? make_to_linear(*out).error : ""; !problem.empty()) wrong(problem);
  }
  bool is_off() const { return json_.is_string() && json_.get<std::string>() == kSwitchedOff; }
  void not_negative(std::optional<double>& out) const {
    if (!json_.is_number() || json_.get<double>() < 0) return wrong_type("a number that is not negative");
    out = json_.get<double>();
  }
  /// The same, or "off".
  void limit(std::optional<double>& out) const {
    if (is_off()) out = std::numeric_limits<double>::infinity();
    else if (json_.is_number() && json_.get<double>() >= 0) out = json_.get<double>();
    else wrong_type("a number that is not negative, or \"off\"");
  }
  void within(std::optional<double>& out, double least, double most) const {
    if (!json_.is_number() || !(json_.get<double>() >= least && json_.get<double>() <= most))
      return wrong_type(fmt::format("a number from {:g} to {:g}", least, most));
    out = json_.get<double>();
  }
  void share(std::optional<double>& out) const;
  void reason(std::optional<std::string>& out) const;
  void measures(bool below, std::map<std::string, double>& out) const;

 private:
  void limit(const std::string& measure, const Value& of, bool below, std::map<std::string, double>& out) const;

  const Json& json_;
  std::string place_;
  Mistakes& mistakes_;
};

/// 0.01 or "1%", or "off": all pixels may.
void Value::share(std::optional<double>& out) const {
  if (is_off()) {
    out = 1;
    return;
  }
  double number = json_.is_number() ? json_.get<double>() : -1;
  if (json_.is_string()) {
    const std::string text = json_.get<std::string>();
    char* end = nullptr;
    if (!text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) || text[0] == '.'))
      number = std::strtod(text.c_str(), &end) / 100;
    if (end == nullptr || std::string_view(end) != "%") number = -1;
  }
  if (json_.is_number() && number == 1)
    return wrong("1 is all pixels, and nothing could fail", "write \"1%\", or \"off\"");
  if (!(number >= 0 && number <= 1)) return wrong_type("a share of the pixels: 0 to 1, \"0%\" to \"100%\", or \"off\"");
  out = number;
}

/// Why a picture is left out, or false.
void Value::reason(std::optional<std::string>& out) const {
  if (json_.is_boolean() && !json_.get<bool>()) out = "";
  else text(out, "the reason as a text, or false");
}

void Value::limit(const std::string& measure, const Value& of, bool below, std::map<std::string, double>& out) const {
  const MeasureRow* row = find_measure(measure);
  if (row == nullptr) {
    std::vector<std::string> names = measure_names(false);
    for (std::string& name : measure_names(true)) names.push_back(std::move(name));
    const std::string meant = did_you_mean(measure, names);
    return of.wrong(fmt::format("there is no measure {}", quoted(measure)),
                    meant.empty() ? fmt::format("there are {}", fmt::join(names, ", ")) : meant);
  }
  if (row->falls != below)
    return of.wrong(fmt::format("lower is {} for {}", row->falls ? "worse" : "better", measure),
                    fmt::format("put it into \"{}\"", row->falls ? "fail_below" : "fail_above"));
  if (of.is_off()) {
    out[measure] = (below ? -1 : 1) * std::numeric_limits<double>::infinity();
  } else if (!of.json_.is_number() || (!below && of.json_.get<double>() < 0)) {
    of.wrong_type(below ? "a number or \"off\"" : "a number that is not negative, or \"off\"");
  } else {
    out[measure] = of.json_.get<double>();
  }
}

void Value::measures(bool below, std::map<std::string, double>& out) const {
  if (!json_.is_object()) return wrong_type("an object of measures and their limits");
  for (const auto& [measure, value] : json_.items())
    limit(measure, Value(value, place_ + step(measure), mistakes_), below, out);
}

/// What a rule may say: a row for each key.
struct Key {
  const char* name;
  std::function<void(const Value&, PolicyRule&)> read;
};

const std::vector<Key>& keys() {
  static const std::vector<Key> table{
      {"match", [](const Value&, PolicyRule&) {}},  // read first: see read_match()
      {"comment",
       [](const Value& v, PolicyRule&) {
         std::optional<std::string> unused;
         v.text(unused, "a text");
       }},
      {"fail_above", [](const Value& v, PolicyRule& r) { v.measures(false, r.says.limits); }},
      {"fail_below", [](const Value& v, PolicyRule& r) { v.measures(true, r.says.limits); }},
      {"fail_pixels", [](const Value& v, PolicyRule& r) { v.share(r.says.fail_pixels); }},
      {"pixel_error", [](const Value& v, PolicyRule& r) { v.not_negative(r.says.pixel_error); }},
      {"hard_fail", [](const Value& v, PolicyRule& r) { v.limit(r.says.hard_fail); }},
      {"exact", [](const Value& v, PolicyRule& r) { v.truth(r.says.exact); }},
      {"noise", [](const Value& v, PolicyRule& r) { v.truth(r.says.noise); }},
      {"alpha", [](const Value& v, PolicyRule& r) { v.within(r.says.alpha, kLeastAlpha, kMostAlpha); }},
      {"allow_nonfinite", [](const Value& v, PolicyRule& r) { v.truth(r.says.allow_nonfinite); }},
      {"channels", [](const Value& v, PolicyRule& r) { v.text(r.says.channels, "a text like \"R,G,B,Albedo.*\""); }},
      {"colorspace", [](const Value& v, PolicyRule& r) { v.colour_space(r.says.colour_space); }},
      {"skip", [](const Value& v, PolicyRule& r) { v.reason(r.says.skip); }},
  };
  return table;
}

std::string match_problem(const std::string& match) {
  if (match.empty()) return "the pattern is empty";
  if (match[0] == '/' || match.rfind("./", 0) == 0)
    return "names are relative to the folder, without / or ./ before them";
  if (match.back() == '/') return "names of pictures do not end in /; ** behind it is all that is in the folder";
  for (const char* never : {"../", "/./", "//"})
    if (match.find(never) != match.npos) return fmt::format("no name of a picture has \"{}\" in it", never);
  return "";
}

void read_match(const Json& rule, const std::string& place, Mistakes& mistakes, PolicyRule& out) {
  const auto found = rule.find("match");
  if (found == rule.end())
    return mistakes.add(place, "the rule has no \"match\"", "say which pictures it is for: \"**\" is all");
  if (!found->is_string()) return mistakes.add(place + "/match", described(*found) + " is not a pattern");
  out.match = found->get<std::string>();
  const std::string problem = match_problem(out.match);
  if (!problem.empty()) mistakes.add(place + "/match", quoted(out.match) + " can match nothing: " + problem);
}

PolicyRule read_rule(const Json& rule, const std::string& place, Mistakes& mistakes) {
  PolicyRule out{place, {}, {}};
  if (!rule.is_object()) {
    mistakes.add(place, described(rule) + " is not a rule", "a rule is an object: {\"match\": \"**\", ...}");
    return out;
  }
  read_match(rule, place, mistakes, out);
  std::vector<std::string> names;
  for (const Key& key : keys()) names.emplace_back(key.name);
  for (const auto& [name, value] : rule.items()) {
    const Value item(value, place + step(name), mistakes);
    const auto key = std::find(names.begin(), names.end(), name);
    if (key != names.end()) {
      keys()[static_cast<size_t>(key - names.begin())].read(item, out);
    } else {
      const std::string meant = did_you_mean(name, names);
      item.wrong(fmt::format("a rule has no {}", quoted(name)),
                 meant.empty() ? fmt::format("it may have {}", fmt::join(names, ", ")) : meant);
    }
  }
  if (out.says.exact.value_or(false) && out.says.limits_anything())
    mistakes.add(place, "asks for equal pictures and for limits at once", "keep \"exact\" or the limits");
  return out;
}

void read_rules(const Json& json, Mistakes& mistakes, Policy& policy) {
  if (!json.is_object())
    return mistakes.add("", described(json) + " is not a policy", "a policy is an object: {\"rules\": [...]}");
  // What has no rules may be anything, and is not quoted.
  const bool is_policy = json.contains("rules");
  for (const auto& [name, value] : json.items()) {
    if (name == "rules" || (name == "comment" && value.is_string())) continue;
    const std::string meant = did_you_mean(name, {"rules", "comment"});
    if (!is_policy && meant.empty()) continue;
    mistakes.add(step(name), name == "comment" ? "is not a text" : fmt::format("a policy has no {}", quoted(name)),
                 meant.empty() ? "it has \"rules\" and perhaps a \"comment\"" : meant);
  }
  const auto rules = json.find("rules");
  if (rules == json.end()) return mistakes.add("", "there are no \"rules\" in it", "write {\"rules\": [...]}");
  if (!rules->is_array()) return mistakes.add("/rules", described(*rules) + " is not an array of rules");
  for (size_t i = 0; i < rules->size(); ++i)
    policy.rules.push_back(read_rule((*rules)[i], fmt::format("/rules/{}", i), mistakes));
}

}  // namespace

Result<Policy> read_policy(const std::string& path) {
  const MappedFile file(path);
  if (!file.error().empty()) return {{}, fmt::format("{}: cannot be read: {}", path, file.error())};
  Mistakes mistakes(path);
  Policy policy{path, {}};
  if (file.bytes().size() > kPolicyBytes.most)
    return {{}, fmt::format("{}: cannot be read: {}", path, more_bytes_than(kPolicyBytes))};
  const Json json = parse(file.bytes(), mistakes);
  if (const std::string changed = file.problem(); !changed.empty()) return {{}, fmt::format("{}: {}", path, changed)};
  if (!mistakes.any()) read_rules(json, mistakes, policy);
  if (mistakes.any()) return {{}, mistakes.text()};
  return {std::move(policy), ""};
}

}  // namespace whit
