#include "core/author/complete.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>

#include "core/author/names.h"
#include "core/author/scope.h"
#include "core/author/vocabulary.h"
#include "parser/lexer.h"
#include "parser/parameters.h"

namespace whit::author {
namespace {

namespace fs = std::filesystem;

/// What of a statement stands before the place where somebody types.
struct Before {
  const StatementRow* row = nullptr;
  std::vector<std::string> names;
  struct Given {
    std::string type, name, value;  ///< The value of a string alone.
  };
  std::vector<Given> parameters;
  enum class At : uint8_t { Statement, Name, Word, Parameter, Value, Nothing } at = At::Statement;
  std::string typed;       ///< Of the word or string that is being written.
  bool in_string = false;  ///< Inside of quotes.
  Span replaces;           ///< What is written and goes on behind the place.
  bool closed = false;     ///< The last of it is the closing quote.
};

/// Reads the words in front of a place, be the statement there right or not.
class Reader {
 public:
  Reader(const File& file, uint64_t offset) : text_(file.text()), offset_(offset) {
    const size_t item = file.index.item_at(offset);
    const bool none = item == file.index.items().size();
    read(none ? 0 : file.index.items()[item].at.begin);
  }

  Before take() { return std::move(out_); }

 private:
  void read(uint64_t start) {
    Diagnostics ignored;
    Reporter reporter(ignored);
    std::vector<Token> comments;
    const std::string_view before = text_.substr(0, offset_);
    Lexer lexer(before, 0, reporter);
    lexer.start_at(std::min(start, offset_));
    lexer.collect_comments(&comments);
    while (lexer.peek().kind != TokenKind::End) {
      const Token token = lexer.next();
      const bool open_string =
          token.kind == TokenKind::Bad && before.find('\n', token.offset) == std::string_view::npos;
      const bool touches = token.end() == offset_ && (token.kind == TokenKind::Word || token.kind == TokenKind::Number);
      if (open_string) return stop_in_string(token);
      if (touches) return stop_in_word(token);
      pass(token);
    }
    const bool in_comment = !comments.empty() && comments.back().end() == offset_;
    out_.replaces = {offset_, offset_};
    stop(in_comment ? Before::At::Nothing : expected());
  }

  /// What comes next, by what there is.
  Before::At expected() const {
    if (!out_.row) return Before::At::Statement;
    const ArgumentRule& rule = out_.row->arguments;
    if (in_list_ || value_wanted_) return Before::At::Value;
    if (numbers_ < rule.numbers) return Before::At::Nothing;
    if (out_.names.size() < rule.min_strings) return Before::At::Name;
    if (out_.names.size() < rule.max_strings && !rule.parameters) return Before::At::Name;
    if (rule.word && !word_given_) return Before::At::Word;
    return rule.parameters ? Before::At::Parameter : Before::At::Statement;
  }

  void stop(Before::At at) { out_.at = at; }

  void stop_in_string(const Token& token) {
    out_.in_string = true;
    out_.typed = std::string(token.text.substr(1));
    // Up to the closing quote where that follows the rest of the word at once.
    uint64_t end = offset_;
    while (end < text_.size() && text_[end] != '"' && text_[end] != '\n' && text_[end] != ' ' && text_[end] != ']')
      ++end;
    // Behind a blank it would be the opening quote of the next parameter.
    out_.closed = end < text_.size() && text_[end] == '"';
    out_.replaces = {token.offset + 1, out_.closed ? end + 1 : end};
    stop(expected());
  }

  void stop_in_word(const Token& token) {
    out_.typed = std::string(token.text);
    uint64_t end = offset_;
    while (end < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[end])) != 0)) ++end;
    out_.replaces = {token.offset, end};
    const Before::At at = expected();
    const bool begins =
        token.kind == TokenKind::Word && at != Before::At::Word && at != Before::At::Value && at != Before::At::Nothing;
    stop(begins ? Before::At::Statement : token.kind == TokenKind::Number ? Before::At::Nothing : at);
  }

  void pass(const Token& token) {
    switch (token.kind) {
      case TokenKind::Word: pass_word(token); break;
      case TokenKind::String: pass_string(token); break;
      case TokenKind::Open: in_list_ = value_wanted_; break;
      case TokenKind::Close: in_list_ = value_wanted_ = false; break;
      case TokenKind::Number:
        if (!value_wanted_) ++numbers_;
        value_wanted_ = in_list_;
        break;
      case TokenKind::Bad:
      case TokenKind::End: break;
    }
  }

  void pass_word(const Token& token) {
    if (const StatementRow* row = find_statement(token.text)) {
      out_.row = row, out_.names.clear(), out_.parameters.clear();
      in_list_ = value_wanted_ = word_given_ = false;
      numbers_ = 0;
    } else if (out_.row && out_.row->arguments.word) {
      word_given_ = true;
    } else if (!value_wanted_) {
      out_.row = nullptr;
    }
  }

  void pass_string(const Token& token) {
    const std::string inside(token.text.substr(1, token.text.size() - 2));
    if (!out_.row) return;
    if (value_wanted_) {
      if (out_.parameters.back().value.empty()) out_.parameters.back().value = inside;
      value_wanted_ = in_list_;
    } else if (out_.names.size() < out_.row->arguments.max_strings) {
      out_.names.push_back(inside);
    } else {
      const size_t space = inside.find_first_of(" \t");
      const size_t name = inside.find_first_not_of(" \t", space);
      out_.parameters.push_back({inside.substr(0, space), name == std::string::npos ? "" : inside.substr(name), ""});
      value_wanted_ = true;
    }
  }

  std::string_view text_;
  uint64_t offset_;
  Before out_;
  bool in_list_ = false, value_wanted_ = false, word_given_ = false;
  int numbers_ = 0;  ///< Of the directive itself.
};

class Completer {
 public:
  Completer(Workspace& workspace, File& file, uint64_t offset)
      : workspace_(workspace), file_(file), offset_(offset), before_(Reader(file, offset).take()) {}

  std::vector<Proposal> run() {
    switch (before_.at) {
      case Before::At::Statement: propose_statements(); break;
      case Before::At::Name: propose_names(); break;
      case Before::At::Word:
        for (const char* word : {"All", "StartTime", "EndTime"}) add(Proposal::Kind::Value, word, "", "").text = word;
        break;
      case Before::At::Parameter:
        propose_parameters();
        if (!before_.in_string && begins_line()) propose_statements();
        break;
      case Before::At::Value: propose_values(); break;
      case Before::At::Nothing: break;
    }
    return std::move(out_);
  }

 private:
  /// Only what is between a line's beginning and the place, and may be a statement there as well.
  bool begins_line() const {
    const std::string_view text = file_.text();
    uint64_t at = before_.replaces.begin;
    while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\t')) --at;
    return at == 0 || text[at - 1] == '\n' || text[at - 1] == '\r';
  }

  const Scope& scope() {
    if (!scope_) {
      const size_t item = file_.index.item_at(offset_);
      const bool none = item == file_.index.items().size();
      // In front of the statement that is being written.
      const bool new_one = before_.at == Before::At::Statement;
      const uint64_t until = none || new_one ? offset_ : file_.index.items()[item].at.begin;
      scope_ = scope_at(workspace_, main(), file_, until);
    }
    return *scope_;
  }
  File& main() {
    if (!main_) main_ = workspace_.main_of(file_);
    return *main_;
  }

  Proposal& add(Proposal::Kind kind, std::string label, std::string detail, std::string doc) {
    Proposal& p = out_.emplace_back();
    p.kind = kind, p.label = std::move(label), p.detail = std::move(detail), p.doc = std::move(doc);
    p.replaces = before_.replaces;
    return p;
  }

  /// Something in quotes, of which the opening one may be there.
  Proposal& add_string(Proposal::Kind kind, const std::string& label, const std::string& value, std::string detail,
                       std::string doc) {
    Proposal& p = add(kind, label, std::move(detail), std::move(doc));
    const std::string opening = before_.in_string ? "" : "\"";
    p.text = opening + escaped(value) + "\"";
    p.filter = opening + escaped(value);
    return p;
  }

  // ---- statements

  void propose_statements() {
    // Of a piece of a scene that nobody includes it is not known which block it stands in.
    const bool known = &main() != &file_ || file_.index.begins_world();
    for (const StatementRow& row : statements()) {
      if (known && row.block == (scope().in_world() ? Block::Options : Block::World)) continue;
      if (known && !stands_here(row)) continue;
      Proposal& p =
          add(Proposal::Kind::Statement, std::string(row.name), std::string(row.arguments.usage), describe(row));
      p.text = statement_snippet(row);
      p.filter = std::string(row.name);
      p.snippet = true;
    }
  }

  /// Whether blocks are open as a statement needs it.
  bool stands_here(const StatementRow& row) {
    const std::vector<const StatementRow*>& blocks = scope().blocks();
    if (row.nesting < 0)
      return !blocks.empty() && blocks.back()->name == std::string(row.name.substr(0, row.name.size() - 3)) + "Begin";
    const bool in_object =
        std::any_of(blocks.begin(), blocks.end(), [](const StatementRow* b) { return b->name == "ObjectBegin"; });
    if (row.name == "WorldEnd") return blocks.empty();
    return !in_object || (row.name != "ObjectBegin" && row.name != "ObjectInstance");
  }

  /// The first name of a kind that is known here, as a snippet has it; another one where there is none.
  std::string first_name(NameKind kind, const std::string& otherwise) {
    const std::vector<std::string> names = kind == NameKind::Medium ? all_media() : scope().names(kind);
    if (names.empty()) return otherwise;
    std::string out;
    for (const char c : escaped(names.front())) {
      if (c == '$' || c == '}' || c == '\\') out += '\\';
      out += c;
    }
    return out;
  }

  std::string statement_snippet(const StatementRow& row) {
    static constexpr std::pair<std::string_view, std::string_view> kOwn[] = {
        {"AttributeBegin", "AttributeBegin\n  $0\nAttributeEnd"},
        {"TransformBegin", "TransformBegin\n  $0\nTransformEnd"},
        {"ObjectBegin", "ObjectBegin \"${1:name}\"\n  $0\nObjectEnd"},
        {"WorldBegin", "WorldBegin\n$0\nWorldEnd"},
        {"Texture", "Texture \"${1:name}\" \"${2|spectrum,float|}\" \"${3:constant}\"$0"},
        {"MakeNamedMaterial", "MakeNamedMaterial \"${1:name}\" \"string type\" \"${2:matte}\"$0"},
        {"MakeNamedMedium", "MakeNamedMedium \"${1:name}\" \"string type\" \"${2:homogeneous}\"$0"},
        {"ActiveTransform", "ActiveTransform ${1|All,StartTime,EndTime|}$0"},
        {"Scale", "Scale ${1:1} ${2:1} ${3:1}$0"},
        {"Rotate", "Rotate ${1:0} ${2:0} ${3:1} ${4:0}$0"},
        {"LookAt", "LookAt ${1:0} ${2:0} ${3:0}  ${4:0} ${5:0} ${6:1}  ${7:0} ${8:1} ${9:0}$0"},
        {"TransformTimes", "TransformTimes ${1:0} ${2:1}$0"},
    };
    for (const auto& [name, snippet] : kOwn) {
      if (name == row.name) return std::string(snippet);
    }
    std::string out(row.name);
    if (row.arguments.numbers == 16) return out + " [ ${1:1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1} ]$0";
    for (int i = 1; i <= row.arguments.numbers; ++i) out += fmt::format(" ${{{}:0}}", i);
    if (row.name == "MediumInterface") {
      const std::string medium = first_name(NameKind::Medium, "");
      return out + fmt::format(" \"${{1:{0}}}\" \"${{2:}}\"$0", medium);
    }
    if (row.arguments.max_strings > 0) out += fmt::format(" \"${{1:{}}}\"$0", first_string(row.name));
    return out;
  }

  /// What a statement may name first without being wrong.
  std::string first_string(std::string_view directive) {
    static constexpr std::pair<std::string_view, const char*> kPlugins[] = {
        {"Accelerator", "bvh"},    {"AreaLightSource", "diffuse"},
        {"Camera", "perspective"}, {"Film", "image"},
        {"Filter", "box"},         {"PixelFilter", "box"},
        {"Integrator", "whitted"}, {"LightSource", "point"},
        {"Material", "matte"},     {"Sampler", "halton"},
        {"Shape", "sphere"},       {"CoordinateSystem", "name"}};
    for (const auto& [name, plugin] : kPlugins) {
      if (name == directive) return plugin;
    }
    const std::optional<NameKind> kind = used_kind(directive);
    return kind ? first_name(*kind, "") : "";
  }

  // ---- names behind a directive

  void propose_names() {
    const std::string_view directive = before_.row->name;
    const size_t index = before_.names.size();
    if (directive == "Texture" && index == 1) {
      for (const char* type : {"float", "spectrum"})
        add_string(Proposal::Kind::Value, type, type, "type of texture", "");
    } else if (static_cast<int>(index) == plugin_string(directive)) {
      propose_plugins();
    } else if (directive == "Include") {
      propose_files({".pbrt"});
    } else if (const auto kind = used_kind(directive)) {
      propose_known(*kind);
    }
  }

  static std::optional<NameKind> used_kind(std::string_view directive) {
    if (directive == "NamedMaterial") return NameKind::Material;
    if (directive == "ObjectInstance") return NameKind::Object;
    if (directive == "CoordSysTransform") return NameKind::CoordinateSystem;
    if (directive == "MediumInterface") return NameKind::Medium;
    return std::nullopt;
  }

  void propose_known(NameKind kind) {
    // Media may be made behind their use.
    const std::vector<std::string> names = kind == NameKind::Medium ? all_media() : scope().names(kind);
    for (const std::string& name : names) add_string(Proposal::Kind::Name, name, name, "", definition_text(kind, name));
  }

  std::vector<std::string> all_media() {
    std::vector<std::string> out;
    for (const File* file : workspace_.files_of(main())) {
      for (const Mention& m : file->index.mentions()) {
        if (m.kind == NameKind::Medium && m.defines) out.push_back(m.name);
      }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  /// The first line of what a name stands for.
  std::string definition_text(NameKind kind, const std::string& name) {
    const int found = scope().find(kind, name);
    if (found < 0) return {};
    const MentionAt& at = scope().definitions()[static_cast<size_t>(found)];
    const Span line = at.file->document.line(at.file->document.line_of(at.get().at.begin));
    return fmt::format("```pbrt\n{}\n```", at.file->text().substr(line.begin, std::min<uint64_t>(line.size(), 200)));
  }

  // ---- plugins and their parameters

  std::string category() const {
    Statement s;
    s.row = before_.row, s.names = before_.names;
    return category_of(s);
  }

  void propose_plugins() {
    for (const PluginInfo* plugin : list_plugins(category()))
      add_string(Proposal::Kind::Plugin, plugin->name, plugin->name, plugin->category, describe(*plugin));
    if (before_.row->name == "AreaLightSource")
      add_string(Proposal::Kind::Plugin, "\"\"", "", "", "No area light from here on.");
  }

  const PluginInfo* plugin() const {
    Statement s;
    s.row = before_.row, s.names = before_.names;
    if (plugin_string(before_.row->name) >= 0) return plugin_of(s);
    for (const Before::Given& g : before_.parameters) {
      if (g.name == "type") return find_plugin(category(), g.value);
    }
    return nullptr;
  }

  /// Of a shape the material's too, which hold for it alone.
  const PluginInfo* worn_material() {
    if (before_.row->name != "Shape") return nullptr;
    const std::optional<ItemAt>& at = scope().material();
    Statement s;
    if (!at) return find_plugin("material", "matte");
    return read_at(at->file->text(), at->file->index.items()[at->item].at.begin, s) ? plugin_of(s) : nullptr;
  }

  bool given(const std::string& name) const {
    return std::any_of(before_.parameters.begin(), before_.parameters.end(),
                       [&](const Before::Given& g) { return g.name == name; });
  }

  void propose_parameters() {
    const bool made = before_.row->name.starts_with("MakeNamed");
    if (made && !given("type")) {
      const bool material = before_.row->name == "MakeNamedMaterial";
      add_parameter("string", "type", material ? "\"${1:matte}\"" : "\"${1:homogeneous}\"", "", "What it is made of.");
    }
    const PluginInfo* own = plugin();
    if (own) propose_parameters_of(*own, nullptr);
    if (const PluginInfo* material = worn_material(); material && material != own)
      propose_parameters_of(*material, own);
  }

  void propose_parameters_of(const PluginInfo& info, const PluginInfo* besides) {
    for (const ParamSpec& spec : info.params) {
      if (given(spec.name) || (besides && besides->find_param(spec.name))) continue;
      bool colour = false;
      for (const ParamType type : spec.accepts) {
        // One proposal for all ways to write a colour.
        if (is_colour(type) && std::exchange(colour, true)) continue;
        std::string detail = facts(spec);
        if (besides) detail += fmt::format("{}of material {}", detail.empty() ? "" : ", ", info.name);
        add_parameter(param_type_name(type), spec.name, value_snippet(spec, type), detail, describe(spec));
      }
    }
  }

  void add_parameter(const std::string& type, const std::string& name, const std::string& value, std::string detail,
                     std::string doc) {
    Proposal& p = add(Proposal::Kind::Parameter, name, std::move(detail), std::move(doc));
    p.detail = p.detail.empty() ? type : type + ": " + p.detail;
    p.text = fmt::format("{}{} {}\" {}$0", before_.in_string ? "" : "\"", type, name, value);
    // Typed is the type first, or the name alone.
    const bool by_name = before_.in_string && before_.typed.find(' ') == std::string::npos &&
                         !find_param_type(before_.typed) && !type.starts_with(before_.typed);
    p.filter = (before_.in_string ? "" : "\"") + (by_name ? name : type + " " + name);
    p.snippet = true;
  }

  /// Numbers alone, as a file may have them.
  static bool is_numbers(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789.+-e ") == std::string::npos;
  }

  /// Something that can be read; what has no default that is written in numbers is 1.
  std::string value_snippet(const ParamSpec& spec, ParamType type) {
    if (type == ParamType::Texture) return "\"${1:" + first_name(texture_kind(&spec), "texture") + "}\"";
    if (type == ParamType::Bool) return spec.default_text == "false" ? "\"${1|false,true|}\"" : "\"${1|true,false|}\"";
    if (!spec.choices.empty()) return fmt::format("\"${{1|{}|}}\"", fmt::join(spec.choices, ","));
    if (type == ParamType::String) {
      std::string inside = spec.default_text;
      if (inside.size() >= 2 && inside.front() == '"') inside = inside.substr(1, inside.size() - 2);
      return spec.is_list ? fmt::format("[ \"${{1:{}}}\" ]", inside) : fmt::format("\"${{1:{}}}\"", inside);
    }
    const bool known = is_numbers(spec.default_text);
    const bool several = known && spec.default_text.find(' ') != std::string::npos;
    if (spec.is_list) return fmt::format("[ ${{1:{}}} ]", known ? spec.default_text : std::string("1"));
    if (is_colour(type)) return fmt::format("[ ${{1:{}}} ]", several ? spec.default_text : std::string("1 1 1"));
    const std::string value = known ? spec.default_text : "1";
    return several ? fmt::format("[ ${{1:{}}} ]", value) : fmt::format("${{1:{}}}", value);
  }

  // ---- values

  void propose_values() {
    if (before_.parameters.empty()) return;
    const Before::Given& given = before_.parameters.back();
    const std::optional<ParamType> type = find_param_type(given.type);
    if (!type) return;
    if (*type == ParamType::Bool) {
      for (const char* value : {"true", "false"}) add_string(Proposal::Kind::Value, value, value, "", "");
    } else if (*type == ParamType::Texture) {
      propose_textures(given.name);
    } else if (*type == ParamType::Spectrum) {
      propose_files({".spd"});
    } else if (*type == ParamType::String) {
      propose_string(given.name);
    }
  }

  const ParamSpec* spec_of(const std::string& name) {
    const PluginInfo* own = plugin();
    if (const ParamSpec* spec = own ? own->find_param(name) : nullptr) return spec;
    const PluginInfo* material = worn_material();
    return material ? material->find_param(name) : nullptr;
  }

  /// Of the kind that the parameter takes.
  void propose_textures(const std::string& parameter) { propose_known(texture_kind(spec_of(parameter))); }

  static NameKind texture_kind(const ParamSpec* spec) {
    const bool colour = spec && std::any_of(spec->accepts.begin(), spec->accepts.end(), is_colour);
    const bool number = spec && std::count(spec->accepts.begin(), spec->accepts.end(), ParamType::Float) > 0;
    return colour && !number   ? NameKind::ColourTexture
           : number && !colour ? NameKind::FloatTexture
                               : NameKind::AnyTexture;
  }

  void propose_string(const std::string& name) {
    const bool made = before_.row->name.starts_with("MakeNamed");
    if (made && name == "type") {
      if (before_.row->name == "MakeNamedMaterial") propose_plugins();
      for (const char* medium : {"homogeneous", "heterogeneous"}) {
        if (before_.row->name == "MakeNamedMedium") add_string(Proposal::Kind::Plugin, medium, medium, "medium", "");
      }
      return;
    }
    if (name.starts_with("namedmaterial")) return propose_known(NameKind::Material);
    const ParamSpec* spec = spec_of(name);
    if (!spec) return;
    for (const std::string& choice : spec->choices)
      add_string(Proposal::Kind::Value, choice, choice, "\"" + choice + "\"" == spec->default_text ? "default" : "",
                 "");
    if (spec->is_file) propose_files(file_endings());
  }

  /// The endings of files that the plugin reads; none where any may be.
  std::vector<std::string> file_endings() const {
    const PluginInfo* info = plugin();
    if (!info) return {};
    if (info->name == "plymesh") return {".ply"};
    if (info->name == "gltf") return {".gltf", ".glb"};
    if (info->name == "imagemap" || info->category == "light")
      return {".exr", ".png", ".tga", ".jpg", ".jpeg", ".pfm", ".hdr", ".tif", ".tiff", ".webp", ".bmp"};
    return {};
  }

  void propose_files(const std::vector<std::string>& endings) {
    constexpr size_t kMost = 1000;
    const size_t slash = before_.typed.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : before_.typed.substr(0, slash + 1);
    std::error_code failed;
    const fs::path in = fs::path(workspace_.resolve(main(), folder.empty() ? "." : folder)).lexically_normal();
    for (fs::directory_iterator i(in, failed), end; !failed && i != end && out_.size() < kMost; i.increment(failed)) {
      const std::string name = i->path().filename().string();
      std::error_code ignored;
      const bool is_folder = i->is_directory(ignored);
      std::string ending = i->path().extension().string();
      std::transform(ending.begin(), ending.end(), ending.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      const bool fits =
          is_folder || endings.empty() || std::find(endings.begin(), endings.end(), ending) != endings.end();
      if (name.starts_with(".") || !fits || i->path() == fs::path(file_.path)) continue;
      Proposal& p = add_string(is_folder ? Proposal::Kind::Folder : Proposal::Kind::File, name,
                               folder + name + (is_folder ? "/" : ""), "", "");
      if (!is_folder) continue;
      // One goes on from a folder: the string is not closed yet, and stays so where it is.
      p.label += "/";
      p.text.pop_back();
      if (before_.closed) --p.replaces.end;
    }
    std::sort(out_.begin(), out_.end(), [](const Proposal& a, const Proposal& b) { return a.label < b.label; });
  }

  Workspace& workspace_;
  File& file_;
  uint64_t offset_;
  Before before_;
  File* main_ = nullptr;
  std::optional<Scope> scope_;
  std::vector<Proposal> out_;
};

}  // namespace

std::vector<Proposal> complete(Workspace& workspace, File& file, uint64_t offset) {
  return Completer(workspace, file, offset).run();
}

}  // namespace whit::author
