#include "core/author/diagnose.h"

#include <filesystem>
#include <utility>

#include "core/base/file_names.h"
#include "core/check/check.h"
#include "core/check/edit.h"
#include "parser/lexer.h"

namespace whit::author {
namespace {

/// From diagnostics to findings: places of bytes become positions.
class Translator {
 public:
  Translator(const Sources& sources, std::string main_file, Encoding encoding)
      : sources_(sources), main_(std::move(main_file)), encoding_(encoding) {
    findings_[main_];
    for (uint32_t file = 0; file < sources.size(); ++file) {
      paths_.push_back(canonical_path(sources.name(file)));
      std::error_code ignored;
      is_file_.push_back(paths_.back() == main_ || std::filesystem::exists(sources.name(file), ignored));
      if (is_file_.back()) findings_[paths_.back()];
    }
  }

  void add(const Diagnostic& d) {
    Finding f;
    f.severity = d.severity;
    f.message = d.message, f.remedy = d.remedy, f.name = d.name, f.slip = d.slip;
    const std::optional<Place> at = place(d.where);
    if (at) f.begin = at->begin, f.end = at->end;
    // Of a text that is no file, such as the statements that stand for a model.
    if (const std::string where = sources_.location(d.where); !at && !where.empty())
      f.message = where + ": " + f.message;
    f.other = place(d.other);
    if (const std::optional<Edit> edit = at ? edit_of(sources_, d) : std::nullopt) {
      const Document& document = documents_.at(edit->file);
      f.word = {document.position(edit->begin), document.position(edit->end)};
    }
    findings_[at ? at->path : main_].push_back(std::move(f));
  }

  Findings take() { return std::move(findings_); }

 private:
  std::optional<Place> place(SourcePos where) {
    if (where.file >= paths_.size() || !is_file_[where.file]) return std::nullopt;
    auto [found, fresh] = documents_.try_emplace(where.file);
    const std::string_view text = sources_.text(where.file);
    if (fresh) found->second = Document(std::string(text), encoding_);
    const uint64_t length = token_at(text, where.offset).size();
    return Place{paths_[where.file], found->second.position(where.offset),
                 found->second.position(where.offset + length)};
  }

  const Sources& sources_;
  std::string main_;
  Encoding encoding_;
  std::vector<std::string> paths_;
  std::vector<bool> is_file_;
  std::map<uint32_t, Document> documents_;
  Findings findings_;
};

}  // namespace

Findings diagnose(const std::string& main_file, const std::vector<OpenText>& open, const DiagnoseOptions& options) {
  ReadOptions read;
  read.read_unplaced = true;
  // A file that is mapped and rewritten in place meanwhile would end the server.
  read.copy_files = true;
  for (const OpenText& o : open) read.unsaved.emplace_back(o.path, *o.text);
  const ParsedFile file = read_scene_file(main_file, read);
  if (options.give_up && options.give_up()) return {};
  const Diagnostics all = check_file(file, main_file, {.build = options.thorough, .give_up = options.give_up});
  Translator translator(*file.sources, canonical_path(main_file), options.encoding);
  for (const Diagnostic& d : all.all()) translator.add(d);
  return translator.take();
}

}  // namespace whit::author
