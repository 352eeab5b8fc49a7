#include "core/author/hover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/author/colours.h"
#include "core/author/names.h"
#include "core/author/scope.h"
#include "core/author/vocabulary.h"
#include "core/base/file_names.h"

namespace whit::author {
namespace {

/// A matrix as people write it: rows, points as columns.
std::string matrix_text(const Mat4d& m) {
  std::string out = "```\n";
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double value = m[column][row];
      out += fmt::format("{}{:>12.6g}", column > 0 ? " " : "", std::abs(value) < 1e-15 ? 0.0 : value);
    }
    out += '\n';
  }
  return out + "```";
}

std::string transforms_text(const TransformPair& t, const std::string& what) {
  if (!t.animated()) return fmt::format("{}\n{}", what, matrix_text(t.start));
  return fmt::format("{}, at the start\n{}\nat the end\n{}", what, matrix_text(t.start), matrix_text(t.end));
}

/// A small picture of a colour, of which Markdown has none of its own.
std::string swatch(const std::string& hex) {
  return fmt::format(
      "![{0}](data:image/svg+xml;utf8,%3Csvg%20xmlns='http://www.w3.org/2000/"
      "svg'%20width='48'%20height='14'%3E%3Crect%20"
      "width='48'%20height='14'%20fill='%23{1}'/%3E%3C/svg%3E)",
      hex, hex.substr(1));
}

std::string colour_text(const RGB& c) {
  const std::string hex = srgb_hex(c);
  // Not where it would be said to be 1.
  const std::string scale = fmt::format("{:.4g}", shown(c).scale);
  return fmt::format("{} linear RGB {:.4g} {:.4g} {:.4g}, sRGB `{}`{}", swatch(hex), c.x, c.y, c.z, hex,
                     shown(c).scale > 1 && scale != "1" ? " times " + scale : std::string());
}

class Hoverer {
 public:
  Hoverer(Workspace& workspace, File& file, uint64_t offset) : workspace_(workspace), file_(file), offset_(offset) {}

  std::optional<Hover> run() {
    const size_t item = file_.index.item_at(offset_);
    if (item == file_.index.items().size()) return std::nullopt;
    item_ = &file_.index.items()[item];
    const std::string_view word = token_at(file_.text(), item_->at.begin);
    const StatementRow* row = item_->row ? item_->row : find_statement(word);
    const Span directive{item_->at.begin, item_->at.begin + word.size()};
    if (row && directive.holds(offset_)) return Hover{directive_text(*row), directive};
    if (offset_ > item_->at.end || !item_->row || !read_at(file_.text(), item_->at.begin, statement_))
      return std::nullopt;
    for (size_t i = 0; i < statement_.names.size(); ++i) {
      const Span at = string_at(file_.text(), statement_.names_at[i].offset);
      if (at.holds(offset_)) return name_hover(i, at);
    }
    for (const Parameter& p : statement_.parameters) {
      if (auto found = parameter_hover(p)) return found;
    }
    return std::nullopt;
  }

 private:
  std::string directive_text(const StatementRow& row) {
    std::string out = describe(row);
    static constexpr std::string_view kPlaced[] = {"Shape",       "Camera",           "ObjectInstance",
                                                   "LightSource", "CoordinateSystem", "Texture"};
    const bool transforms = row.name == "CoordSysTransform" ||
                            (row.arguments.numbers > 0 && row.name != "TransformTimes") || row.name == "Identity";
    const bool placed = std::find(std::begin(kPlaced), std::end(kPlaced), row.name) != std::end(kPlaced);
    if (!item_->row || !(transforms || placed)) return out;
    // With the statement itself, be it one that changes the transforms.
    const Scope scope = scope_at(workspace_, *workspace_.main_of(file_), file_, item_->at.begin + 1);
    const auto t = row.name == "Camera" ? before() : scope.transforms();
    if (!t) return out;
    const std::string what = row.name == "Camera" || !scope.in_world() ? "World to camera" : "Object to world";
    return out + "\n\n" + transforms_text(*t, what);
  }

  std::optional<TransformPair> before() {
    return scope_at(workspace_, *workspace_.main_of(file_), file_, item_->at.begin).transforms();
  }

  std::optional<Hover> name_hover(size_t i, Span at) {
    if (static_cast<int>(i) == plugin_string(statement_.row->name)) {
      const PluginInfo* plugin = plugin_of(statement_);
      if (plugin) return Hover{describe(*plugin), at};
      return std::nullopt;
    }
    return mention_hover();
  }

  /// What a name stands for: the statement that says so.
  std::optional<Hover> mention_hover() {
    const Mention* mention = file_.index.mention_at(offset_);
    if (!mention) return std::nullopt;
    if (mention->kind == NameKind::Include || mention->kind == NameKind::Asset) return file_hover(*mention);
    const std::vector<SpanAt> found = definition_at(workspace_, file_, offset_);
    if (found.empty()) return std::nullopt;
    std::string out;
    for (const SpanAt& d : found) {
      constexpr uint64_t kMost = 500;
      const Item& item = d.file->index.items()[d.file->index.item_at(d.span.begin)];
      const uint64_t size = std::min(kMost, item.at.size());
      out += fmt::format("{}```pbrt\n{}{}\n```", out.empty() ? "" : "\n", d.file->text().substr(item.at.begin, size),
                         size < item.at.size() ? " ..." : "");
    }
    return Hover{out, mention->at};
  }

  std::optional<Hover> file_hover(const Mention& mention) {
    const std::string path = canonical_path(workspace_.resolve(*workspace_.main_of(file_), mention.name));
    std::error_code failed;
    const auto bytes = std::filesystem::file_size(path, failed);
    return Hover{fmt::format("`{}`{}", path, failed ? ": there is no such file" : fmt::format(", {} bytes", bytes)),
                 mention.at};
  }

  std::optional<Hover> parameter_hover(const Parameter& p) {
    const Span declaration = string_at(file_.text(), p.where.offset);
    const bool on_name = declaration.holds(offset_);
    const std::vector<Span> values = value_spans(file_.text(), p);
    const Span list{p.values_at.offset, values.empty() ? p.values_at.offset + 1 : values.back().end};
    if (!on_name && !list.holds(offset_)) return std::nullopt;
    if (!on_name && file_.index.mention_at(offset_)) {
      auto found = mention_hover();
      if (const std::string text = colour(p); found && !text.empty()) found->markdown += "\n\n" + text;
      return found;
    }
    std::string out = parameter_text(p);
    if (const std::string text = colour(p); !text.empty()) out += (out.empty() ? "" : "\n\n") + text;
    if (out.empty()) return std::nullopt;
    return Hover{out, on_name ? declaration : list};
  }

  std::string colour(const Parameter& p) {
    const auto found = is_colour(p.type)
                           ? colour_of(p, std::filesystem::path(workspace_.main_of(file_)->path).parent_path().string())
                           : std::nullopt;
    return found ? colour_text(*found) : std::string();
  }

  std::string parameter_text(const Parameter& p) {
    const PluginInfo* plugin = plugin_of(statement_);
    const ParamSpec* spec = plugin ? plugin->find_param(p.name) : nullptr;
    if (spec) return describe(*spec);
    if (statement_.row->name != "Shape") return {};
    const Scope scope = scope_at(workspace_, *workspace_.main_of(file_), file_, item_->at.begin);
    Statement material;
    const PluginInfo* worn = find_plugin("material", "matte");
    if (const auto& at = scope.material();
        at && read_at(at->file->text(), at->file->index.items()[at->item].at.begin, material))
      worn = plugin_of(material);
    spec = worn ? worn->find_param(p.name) : nullptr;
    return spec ? fmt::format("{}\n\nOf the material {}, for this shape alone.", describe(*spec), worn->name) : "";
  }

  Workspace& workspace_;
  File& file_;
  uint64_t offset_;
  const Item* item_ = nullptr;
  Statement statement_;
};

}  // namespace

std::optional<Hover> hover(Workspace& workspace, File& file, uint64_t offset) {
  return Hoverer(workspace, file, offset).run();
}

}  // namespace whit::author
