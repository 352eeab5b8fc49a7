#include "parser/format.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <ostream>

#include "parser/include.h"
#include "parser/lexer.h"
#include "parser/ply_export.h"
#include "parser/reporter.h"
#include "parser/statements.h"

namespace whit {

namespace {

namespace fs = std::filesystem;

/// Collects text and passes it on in large pieces, since a mesh statement is millions of small ones.
class TextWriter {
 public:
  explicit TextWriter(std::ostream& out) : out_(out) {}
  ~TextWriter() { flush(); }
  TextWriter(const TextWriter&) = delete;
  TextWriter& operator=(const TextWriter&) = delete;

  void text(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() > kPiece) flush();
  }

  /// The shortest digits that read back as the same number.
  template <class T>
  void number(T value) {
    char digits[32];
    const std::to_chars_result result = std::to_chars(digits, digits + sizeof digits, value);
    text({digits, static_cast<size_t>(result.ptr - digits)});
  }

  void string(std::string_view value) {
    buffer_ += '"';
    for (const char c : value) {
      if (const char* escape = escaped(c)) {
        buffer_ += escape;
      } else {
        buffer_ += c;
      }
    }
    text("\"");
  }

 private:
  static constexpr size_t kPiece = 1 << 16;

  static const char* escaped(char c) {
    switch (c) {
      case '\b': return "\\b";
      case '\f': return "\\f";
      case '\n': return "\\n";
      case '\r': return "\\r";
      case '\t': return "\\t";
      case '\\': return "\\\\";
      case '"': return "\\\"";
      default: return nullptr;
    }
  }

  void flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }

  std::ostream& out_;
  std::string buffer_;
};

/// The spelling of a type that every version of pbrt reads.
std::string_view written_type(ParamType type) {
  switch (type) {
    case ParamType::Point3: return "point";
    case ParamType::Vector3: return "vector";
    default: return param_type_name(type);
  }
}

/// Writes statements; knows nothing of comments and lines.
class StatementWriter {
 public:
  explicit StatementWriter(TextWriter& out) : out_(out) {}

  void write(const Statement& s) {
    out_.text(s.row->name);
    for (const std::string& name : s.names) {
      out_.text(" ");
      out_.string(name);
    }
    if (s.row->arguments.word) out_.text(" " + s.word);
    const size_t count = s.row->arguments.numbers;
    if (count == 16) out_.text(" [");
    for (size_t i = 0; i < count; ++i) {
      out_.text(" ");
      out_.number(s.numbers[i]);
    }
    if (count == 16) out_.text(" ]");
    for (const Parameter& parameter : s.parameters) write(parameter);
  }

 private:
  void write(const Parameter& p) {
    out_.text(" ");
    out_.string(std::string(written_type(p.type)) + " " + p.name);
    if (p.type == ParamType::Bool) {
      list(p.bools(), [&](uint8_t value) { out_.text(value ? "\"true\"" : "\"false\""); });
    } else if (p.type == ParamType::Texture) {
      list(p.textures(), [&](const TextureRef& value) { out_.string(value.name); });
    } else if (p.type == ParamType::Integer) {
      list(p.integers(), [&](int32_t value) { out_.number(value); });
    } else if (!p.strings().empty()) {
      list(p.strings(), [&](const std::string& value) { out_.string(value); });
    } else {
      list(p.numbers(), [&](double value) { out_.number(value); });
    }
  }

  template <class T, class Put>
  void list(const std::vector<T>& values, Put put) {
    const bool brackets = values.size() != 1;
    if (brackets) out_.text(" [");
    for (const T& value : values) {
      out_.text(" ");
      put(value);
    }
    if (brackets) out_.text(" ]");
  }

  TextWriter& out_;
};

/// Reads statements and lays them out in lines, with the comments between them.
class Formatter {
 public:
  Formatter(Sources& sources, Reporter& reporter, std::string folder, std::ostream& out, const FormatOptions& options)
      : sources_(sources),
        reporter_(reporter),
        folder_(std::move(folder)),
        options_(options),
        inclusion_(sources, reporter, folder_),
        out_(out),
        writer_(out_) {}

  void format(uint32_t main_file) {
    push(main_file);
    while (!open_.empty()) {
      const uint64_t errors = reporter_.errors();
      const ReadResult result = read_statement(open_.back().lexer, statement_);
      append_trailing(open_.back().lexer, result, open_.back().trailing, statement_);
      put_comments_before(statement_);
      if (result == ReadResult::End) {
        pop();
      } else if (result == ReadResult::Broken && !sources_.problem().empty()) {
        break;
      } else if (result == ReadResult::Broken || reporter_.errors() != errors) {
        put_verbatim();
      } else {
        put_statement();
        if (inclusion_.exhausted()) break;
      }
    }
    if (line_open_) out_.text("\n");
  }

 private:
  struct OpenFile {
    OpenFile(std::string_view text, uint32_t number, ParameterList behind, Reporter& reporter)
        : file(number), lexer(text, number, reporter), trailing(std::move(behind)) {}
    uint32_t file;
    Lexer lexer;
    ParameterList trailing;       ///< Those behind the Include, for the last statement.
    std::vector<Token> comments;  ///< Read, not yet written.
    uint64_t written_to = 0;      ///< The byte of the file behind the last thing written.
  };

  void push(uint32_t file, ParameterList trailing = {}) {
    open_.emplace_back(sources_.text(file), file, std::move(trailing), reporter_);
    // The lexers hold the address of their file's comments, which moves with the stack.
    for (OpenFile& open : open_) open.lexer.collect_comments(&open.comments);
    inclusion_.enter(file);
  }

  void pop() {
    open_.pop_back();
    inclusion_.leave();
  }

  std::string_view text() { return open_.back().lexer.text(); }

  /// How many newlines there are between the last thing written and `offset`.
  int64_t newlines_before(uint64_t offset) {
    const uint64_t from = open_.back().written_to;
    if (offset <= from) return 0;
    const std::string_view gap = text().substr(from, offset - from);
    return std::count(gap.begin(), gap.end(), '\n');
  }

  /// Starts an output line for something that begins at `offset` of the file.
  void begin_line(uint64_t offset) {
    if (line_open_) out_.text("\n");
    if (line_open_ && newlines_before(offset) > 1) out_.text("\n");
    line_open_ = true;
    for (size_t i = 0; i < depth_; ++i) out_.text(options_.indent);
  }

  static std::string_view trimmed(std::string_view text) {
    const size_t last = text.find_last_not_of(" \t\r\n\v\f");
    return last == std::string_view::npos ? std::string_view() : text.substr(0, last + 1);
  }

  /// Writes the comments in front of a statement, then those inside it; what is behind it waits.
  void put_comments_before(const Statement& s) {
    OpenFile& file = open_.back();
    size_t done = 0;
    for (; done < file.comments.size() && file.comments[done].offset < s.where.offset; ++done) {
      const Token& comment = file.comments[done];
      const bool trailing = line_open_ && file.written_to > 0 && newlines_before(comment.offset) == 0;
      if (trailing) {
        out_.text("  ");
      } else {
        begin_line(comment.offset);
      }
      out_.text(trimmed(comment.text));
      file.written_to = comment.end();
    }
    file.comments.erase(file.comments.begin(), file.comments.begin() + static_cast<std::ptrdiff_t>(done));
  }

  void put_comments_inside() {
    OpenFile& file = open_.back();
    size_t done = 0;
    for (; done < file.comments.size() && file.comments[done].offset < statement_.end; ++done) {
      begin_line(statement_.where.offset);
      out_.text(trimmed(file.comments[done].text));
      file.written_to = statement_.where.offset;
    }
    file.comments.erase(file.comments.begin(), file.comments.begin() + static_cast<std::ptrdiff_t>(done));
  }

  /// Copies a statement with a mistake, comments and all.
  void put_verbatim() {
    OpenFile& file = open_.back();
    const auto inside = [this](const Token& comment) { return comment.offset < statement_.end; };
    file.comments.erase(file.comments.begin(), std::find_if_not(file.comments.begin(), file.comments.end(), inside));
    const uint64_t start = statement_.where.offset;
    const std::string_view raw = trimmed(text().substr(start, statement_.end - start));
    begin_line(start);
    out_.text(raw);
    file.written_to = start + raw.size();
  }

  void put_statement() {
    if (options_.expand_includes && statement_.row == find_statement("Include")) {
      expand_include();
      return;
    }
    if (statement_.row->nesting < 0 && depth_ > 0) --depth_;
    put_comments_inside();
    if (options_.to_ply && can_export_mesh(statement_)) export_mesh();
    begin_line(statement_.where.offset);
    writer_.write(statement_);
    open_.back().written_to = statement_.end;
    if (statement_.row->nesting > 0) ++depth_;
  }

  /// Puts a mesh into a file of its own, with the first name from mesh_00001.ply on that is free.
  void export_mesh() {
    const std::string ply = mesh_as_ply(statement_);
    std::string path, name, problem;
    NewFile outcome = NewFile::NameTaken;
    while (outcome == NewFile::NameTaken) {
      char digits[16];
      std::snprintf(digits, sizeof digits, "%05d", ++meshes_);
      name = std::string("mesh_") + digits + ".ply";
      path = join_path(options_.ply_folder, name);
      outcome = write_new_file(path, ply, problem);
    }
    if (outcome == NewFile::Failed) {
      reporter_.file_error(statement_.where, "cannot write " + quoted_path(path) + ": " + problem);
      return;
    }
    if (outcome == NewFile::Written && options_.written) options_.written->push_back(path);
    replace_by_plymesh(statement_, name);
  }

  void expand_include() {
    put_comments_inside();
    open_.back().written_to = statement_.end;
    if (const auto file = inclusion_.open(statement_.names[0], statement_.names_at[0]))
      push(*file, std::move(statement_.parameters));
  }

  Sources& sources_;
  Reporter& reporter_;
  std::string folder_;
  const FormatOptions& options_;
  Inclusion inclusion_;
  TextWriter out_;
  StatementWriter writer_;
  std::vector<OpenFile> open_;
  Statement statement_;
  size_t depth_ = 0;
  bool line_open_ = false;
  int meshes_ = 0;
};

Diagnostics format(Sources& sources, uint32_t file, std::string folder, std::ostream& out,
                   const FormatOptions& options) {
  Diagnostics diagnostics;
  Reporter reporter(diagnostics);
  // A file that is empty, or nothing but space, may be included.
  if (!sources.text(file).empty() && check_is_scene(sources, file, reporter)) {
    Formatter(sources, reporter, std::move(folder), out, options).format(file);
  }
  reporter.finish();
  check_unchanged(sources, diagnostics);
  return diagnostics;
}

}  // namespace

Diagnostics format_file(Sources& sources, const std::string& path, std::ostream& out, const FormatOptions& options) {
  Diagnostics diagnostics;
  const std::optional<uint32_t> file = open_main(sources, path, diagnostics);
  if (!file) return diagnostics;
  return format(sources, *file, fs::path(path).parent_path().string(), out, options);
}

Diagnostics format_text(Sources& sources, std::string name, std::string text, std::string folder, std::ostream& out,
                        const FormatOptions& options) {
  return format(sources, sources.add_text(std::move(name), std::move(text)), std::move(folder), out, options);
}

}  // namespace whit
