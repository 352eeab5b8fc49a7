#include "parser/instance_names.h"

#include "core/base/limits.h"
#include "parser/include.h"
#include "parser/lexer.h"
#include "parser/reporter.h"

namespace whit {

namespace {

/// Goes through the tokens of the files, in the order in which they will be read. The files are a stack of its own, so
/// that the depth of inclusion is not limited by the program's.
class LookAhead {
 public:
  LookAhead(Sources& sources, const std::string& folder, const std::vector<ReadingPlace>& open)
      : sources_(sources), folder_(folder) {
    for (const ReadingPlace& place : open) push(place);
  }

  std::optional<InstanceNames> run() {
    while (sure() && !world_ended_ && !files_.empty()) {
      File& file = files_.back();
      const Token token = file.lexer.next();
      release(file);
      switch (token.kind) {
        case TokenKind::Open: sure_ = file.lexer.skip_list(); break;
        case TokenKind::Word: take_word(file.lexer, token.text); break;
        case TokenKind::End: leave(); break;
        default: break;  // Strings and numbers of statements that do not matter.
      }
    }
    if (!sure() || !world_ended_ || in_object_) return std::nullopt;
    return std::move(names_);
  }

 private:
  struct File {
    uint32_t file;
    uint64_t start;     ///< Where in the file the lexer's text starts.
    bool entered_here;  ///< By an Include met while looking ahead.
    Lexer lexer;
    uint64_t released = 0;
  };

  void push(ReadingPlace place, bool entered_here = false) {
    const std::string_view text = sources_.text(place.file);
    files_.push_back({place.file, place.offset, entered_here, Lexer(text.substr(place.offset), place.file, reporter_)});
  }

  bool sure() const { return sure_ && reporter_.errors() == 0; }

  void take_word(Lexer& lexer, std::string_view word) {
    if (word == "ObjectInstance") {
      if (const auto name = take_string(lexer)) names_.insert(*name);
    } else if (word == "ObjectBegin") {
      sure_ = !in_object_;
      in_object_ = true;
    } else if (word == "ObjectEnd") {
      sure_ = in_object_;
      in_object_ = false;
    } else if (word == "WorldEnd") {
      world_ended_ = true;
    } else if (word == "Include" && !in_object_) {
      if (const auto path = take_string(lexer)) enter(*path);
    }
  }

  /// The string behind a directive, which leaves a doubt when it is missing.
  std::optional<std::string> take_string(Lexer& lexer) {
    sure_ = lexer.peek().kind == TokenKind::String;
    if (!sure_) return std::nullopt;
    return lexer.unquote(lexer.next());
  }

  void enter(const std::string& path) {
    const std::string full = join_path(folder_, path);
    std::string problem;
    const std::optional<uint32_t> file = sources_.open(full, problem);
    sure_ = file.has_value() && files_.size() < kIncludeDepth.most;
    // A second look at a file finds nothing new; so files that include one another come to an end, too.
    if (sure_ && entered_.insert(*file).second) push({*file, 0}, true);
  }

  void leave() {
    const File& file = files_.back();
    // An object that begins in an included file and ends behind it: the next Include of that file would open it again.
    if (file.entered_here && in_object_) sure_ = false;
    files_.pop_back();
  }

  /// What has been looked through of a large file need not stay in memory.
  void release(File& file) const {
    constexpr uint64_t kLeast = uint64_t{1} << 24;
    const uint64_t behind = file.lexer.consumed();
    if (behind - file.released < kLeast) return;
    sources_.release(file.file, file.start + file.released, file.start + behind);
    file.released = behind;
  }

  Sources& sources_;
  const std::string& folder_;
  Diagnostics problems_;  ///< Whatever is in them: the parser will find the same.
  Reporter reporter_{problems_};
  std::vector<File> files_;
  std::unordered_set<uint32_t> entered_;
  InstanceNames names_;
  bool in_object_ = true, world_ended_ = false, sure_ = true;
};

}  // namespace

std::optional<InstanceNames> names_of_instances(Sources& sources, const std::string& folder,
                                                const std::vector<ReadingPlace>& open) {
  return LookAhead(sources, folder, open).run();
}

}  // namespace whit
