#include "parser/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <sstream>

#include "core/base/file_names.h"
#include "core/base/limits.h"
#include "core/base/mapped_file.h"

namespace whit {

namespace {

/// The length of the UTF-8 sequence at `at`, 0 when the bytes there are none.
size_t utf8_length(std::string_view text, size_t at) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(at);
  const size_t length = lead < 0x80 ? 1 : lead >= 0xc2 && lead < 0xe0 ? 2 : (lead & 0xf0) == 0xe0 ? 3 : 4;
  if (lead >= 0x80 && (lead < 0xc2 || lead > 0xf4)) return 0;
  if (at + length > text.size()) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
  if (length == 3 && ((lead == 0xe0 && byte(at + 1) < 0xa0) || (lead == 0xed && byte(at + 1) >= 0xa0))) return 0;
  if (length == 4 && ((lead == 0xf0 && byte(at + 1) < 0x90) || (lead == 0xf4 && byte(at + 1) >= 0x90))) return 0;
  return length;
}

std::string hex_escape(unsigned char byte) {
  constexpr char kDigits[] = "0123456789abcdef";
  return std::string("\\x") + kDigits[byte >> 4] + kDigits[byte & 15];
}

bool is_control(unsigned char byte) { return byte < 0x20 || byte == 0x7f; }

/// The code point that a valid sequence of UTF-8 encodes.
uint32_t code_point(std::string_view sequence) {
  const auto lead = static_cast<unsigned char>(sequence[0]);
  uint32_t code = sequence.size() == 1 ? lead : lead & (0x7fu >> sequence.size());
  for (const char c : sequence.substr(1)) code = code << 6 | (static_cast<unsigned char>(c) & 0x3fu);
  return code;
}

/// Characters that look like a space or like nothing, and those that turn the direction of what follows.
bool is_unseen(uint32_t code) {
  return code == 0xa0 || code == 0xad || code == 0x1680 || (code >= 0x2000 && code <= 0x200f) ||
         (code >= 0x2028 && code <= 0x202f) || (code >= 0x205f && code <= 0x206f) || code == 0x3000 || code == 0xfeff;
}

std::string unicode_escape(uint32_t code) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out = "\\u";
  for (int shift = 12; shift >= 0; shift -= 4) out += kDigits[code >> shift & 15];
  return out;
}

/// One code point at `at` as a terminal can show it; `length` is how many bytes of the text it covers.
std::string visible(std::string_view text, size_t at, size_t& length) {
  length = utf8_length(text, at);
  const auto byte = static_cast<unsigned char>(text[at]);
  // U+0080 to U+009F are control characters too, and some terminals obey them.
  const bool c1 = length == 2 && byte == 0xc2 && static_cast<unsigned char>(text[at + 1]) < 0xa0;
  if (length > 1 && !c1 && is_unseen(code_point(text.substr(at, length))))
    return unicode_escape(code_point(text.substr(at, length)));
  if (length > 0 && !is_control(byte) && !c1) return std::string(text.substr(at, length));
  length = std::max<size_t>(length, 1);
  if (byte == '\t') return "    ";
  std::string out;
  for (size_t i = 0; i < length; ++i) out += hex_escape(static_cast<unsigned char>(text[at + i]));
  return out;
}

size_t count_code_points(std::string_view text) {
  size_t count = 0;
  for (size_t i = 0; i < text.size(); ++count) i += std::max<size_t>(utf8_length(text, i), 1);
  return count;
}

size_t columns(const std::string& cell) { return count_code_points(cell); }

size_t columns(const std::vector<std::string>& cells) {
  size_t sum = 0;
  for (const std::string& cell : cells) sum += columns(cell);
  return sum;
}

}  // namespace

/// One file: its bytes, and the number of lines before each block of them, counted when first asked for.
class Sources::File {
 public:
  File(std::string file_name, std::string text) : name(std::move(file_name)), owned_(std::move(text)) {
    text_ = owned_;
  }
  File(std::string file_name, std::unique_ptr<const MappedFile> mapped)
      : name(std::move(file_name)), mapped_(std::move(mapped)), text_(mapped_->bytes()) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  std::string_view text() const { return text_; }

  void release(uint64_t begin, uint64_t end) const {
    if (mapped_) mapped_->release(begin, end);
  }

  /// "", or what has happened to the file since it was opened.
  std::string problem() const { return mapped_ ? mapped_->problem() : std::string(); }

  /// How many newlines there are before `offset`.
  uint64_t lines_before(uint64_t offset) const {
    const uint64_t block = offset / kBlock;
    const std::lock_guard<std::mutex> lock(mutex_);
    while (counts_.size() <= block) {
      const std::string_view last = text_.substr((counts_.size() - 1) * kBlock, kBlock);
      counts_.push_back(counts_.back() + static_cast<uint64_t>(std::count(last.begin(), last.end(), '\n')));
    }
    const std::string_view rest = text_.substr(block * kBlock, offset - block * kBlock);
    return counts_[block] + static_cast<uint64_t>(std::count(rest.begin(), rest.end(), '\n'));
  }

  /// True when `now` is the file as it was when it was opened.
  bool is(const FileState& now) const { return mapped_ && mapped_->state() == now; }

  bool is_on_disk() const { return mapped_ != nullptr; }

  std::string name;
  bool hidden = false;

 private:
  /// Small, because whole lists of places are asked for; a thousandth of the text in memory.
  static constexpr uint64_t kBlock = 1 << 13;

  std::string owned_;  ///< Where no file is.
  std::unique_ptr<const MappedFile> mapped_;
  std::string_view text_;
  mutable std::mutex mutex_;
  mutable std::vector<uint64_t> counts_{0};
};

Sources::Sources() : copied_bytes_(MappedFile::kCopied) {}
Sources::~Sources() = default;

const Sources::File* Sources::find(uint32_t file) const { return file < files_.size() ? files_[file].get() : nullptr; }

void Sources::stand_in(const std::string& path, std::string text) {
  stand_ins_[canonical_path(path)] = add_text(path, std::move(text));
}

std::optional<uint32_t> Sources::stand_in_for(const std::string& path) const {
  if (stand_ins_.empty()) return std::nullopt;
  const auto found = stand_ins_.find(canonical_path(path));
  if (found == stand_ins_.end()) return std::nullopt;
  return found->second;
}

std::optional<uint32_t> Sources::open(const std::string& path, std::string& problem, Pipes pipes) {
  problem.clear();
  if (const auto edited = stand_in_for(path)) return edited;
  struct stat status = {};
  const bool there = ::stat(path.c_str(), &status) == 0;
  if (there && S_ISFIFO(status.st_mode) && pipes == Pipes::Read) return open_pipe(path, problem);
  const FileState now = there ? state_of(status) : FileState{};
  const auto known = on_disk_.find({now.device, now.inode});
  if (known != on_disk_.end() && files_[known->second]->is(now)) return known->second;
  auto mapped = std::make_unique<const MappedFile>(path, copied_bytes_);
  problem = mapped->error();
  if (!problem.empty()) return std::nullopt;
  const auto number = static_cast<uint32_t>(files_.size());
  on_disk_[{mapped->state().device, mapped->state().inode}] = number;
  files_.push_back(std::make_unique<File>(path, std::move(mapped)));
  return number;
}

std::optional<uint32_t> Sources::open_pipe(const std::string& path, std::string& problem) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    problem = std::strerror(errno);
    return std::nullopt;
  }
  std::optional<std::string> text = read_pipe(descriptor, problem);
  ::close(descriptor);
  if (!text) return std::nullopt;
  return add_text(path, std::move(*text));
}

std::string Sources::problem() const {
  for (const auto& file : files_) {
    const std::string problem = file->problem();
    if (!problem.empty()) return printable(file->name) + ": " + problem;
  }
  return {};
}

std::string Sources::problem(uint32_t file) const {
  const File* f = find(file);
  return f ? f->problem() : std::string();
}

uint32_t Sources::add_text(std::string name, std::string text) {
  files_.push_back(std::make_unique<File>(std::move(name), std::move(text)));
  return static_cast<uint32_t>(files_.size() - 1);
}

std::string_view Sources::text(uint32_t file) const {
  const File* f = find(file);
  return f ? f->text() : std::string_view();
}

void Sources::release(uint32_t file, uint64_t begin, uint64_t end) const {
  if (const File* f = find(file)) f->release(begin, end);
}

void Sources::hide(uint32_t file) {
  if (file < files_.size()) files_[file]->hidden = true;
}

bool Sources::is_on_disk(uint32_t file) const {
  const File* f = find(file);
  return f && f->is_on_disk();
}

const std::string& Sources::name(uint32_t file) const {
  static const std::string none;
  const File* f = find(file);
  return f ? f->name : none;
}

SourcePlace Sources::place(SourcePos where) const {
  const File* file = find(where.file);
  if (!file || !file->problem().empty()) return {};
  const std::string_view text = file->text();
  const uint64_t offset = std::min<uint64_t>(where.offset, text.size());
  const std::string_view before = text.substr(0, offset);
  const size_t newline = before.rfind('\n');
  const size_t start = newline == std::string_view::npos ? 0 : newline + 1;
  return {file->lines_before(offset) + 1, count_code_points(before.substr(start)) + 1};
}

std::string Sources::location(SourcePos where) const {
  const File* file = find(where.file);
  if (!file) return {};
  const SourcePlace at = place(where);
  if (at.line == 0) return printable(file->name) + " (changed since)";
  return printable(file->name) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
}

std::string Sources::excerpt(SourcePos where, bool colour) const {
  const File* file = find(where.file);
  if (!file || file->hidden || !file->problem().empty()) return {};
  // Twice the columns shown, so that a line of four-byte code points still fills its half of the window.
  constexpr size_t kReach = 240, kColumns = 100, kHalf = kColumns / 2;
  const std::string_view text = file->text();
  const size_t offset = std::min<size_t>(where.offset, text.size());
  size_t start = offset;
  while (start > 0 && offset - start < kReach && text[start - 1] != '\n') --start;
  size_t stop = offset;
  while (stop < text.size() && stop - offset < kReach && text[stop] != '\n') ++stop;
  bool cut_left = start > 0 && text[start - 1] != '\n';
  bool cut_right = stop < text.size() && text[stop] != '\n';
  while (cut_left && start < offset && (static_cast<unsigned char>(text[start]) & 0xc0) == 0x80) ++start;
  if (stop > offset && !cut_right && text[stop - 1] == '\r') --stop;
  const std::string_view window = text.substr(0, stop);
  std::vector<std::string> left, right;
  for (size_t at = start, length = 0; at < stop; at += length)
    (at < offset ? left : right).push_back(visible(window, at, length));

  // The caret's half may be wider when the other needs less than its own.
  const size_t all_before = columns(left), all_after = columns(right);
  const size_t room_after = std::max(kHalf, kColumns - std::min(kColumns, all_before));
  const size_t room_before = kColumns - std::min(room_after, all_after);
  size_t columns_before = 0, columns_after = 0, first = left.size(), last = 0;
  while (first > 0 && columns_before + columns(left[first - 1]) <= room_before)
    columns_before += columns(left[--first]);
  while (last < right.size() && columns_after + columns(right[last]) <= room_after)
    columns_after += columns(right[last++]);
  std::string before, after;
  for (size_t i = first; i < left.size(); ++i) before += left[i];
  for (size_t i = 0; i < last; ++i) after += right[i];
  cut_left = cut_left || first > 0;
  cut_right = cut_right || last < right.size();
  if (before.empty() && after.empty()) return {};
  const size_t indent = 4 + (cut_left ? 4 : 0) + columns_before;
  return "    " + std::string(cut_left ? "... " : "") + before + after + (cut_right ? " ..." : "") + "\n" +
         std::string(indent, ' ') + (colour ? "\033[1;32m^\033[0m" : "^") + "\n";
}

std::string Sources::render_diagnostic(const Diagnostic& diagnostic, bool colour) const {
  struct Look {
    const char *word, *colour;
  };
  constexpr Look kLooks[] = {{"warning:", "\033[1;35m"}, {"error:", "\033[1;31m"}, {"note:", "\033[1;36m"}};
  const Look& look = kLooks[static_cast<size_t>(diagnostic.severity)];
  const bool located = find(diagnostic.where.file) != nullptr;
  std::string out;
  if (located) out += colour ? "\033[1m" + location(diagnostic.where) + ":\033[0m " : location(diagnostic.where) + ": ";
  if (colour) out += look.colour;
  out += look.word;
  if (colour) out += "\033[0m";
  out.append(" ").append(printable(diagnostic.message)).append("\n");
  if (located) out += excerpt(diagnostic.where, colour);
  if (find(diagnostic.other.file)) out += "  and " + location(diagnostic.other) + "\n";
  std::istringstream remedy(diagnostic.remedy);
  for (std::string line; std::getline(remedy, line);) out.append("  ").append(printable(line)).append("\n");
  return out;
}

std::optional<std::string> read_pipe(int descriptor, std::string& problem) {
  problem.clear();
  std::string text;
  std::vector<char> chunk(size_t{1} << 16);
  for (;;) {
    const ssize_t got = ::read(descriptor, chunk.data(), chunk.size());
    if (got == 0) return text;
    if (got < 0 && errno != EINTR) problem = std::strerror(errno);
    const auto bytes = static_cast<size_t>(std::max<ssize_t>(got, 0));
    if (text.size() + bytes > kPipedBytes.most) problem = more_bytes_than(kPipedBytes);
    if (!problem.empty()) return std::nullopt;
    text.append(chunk.data(), bytes);
  }
}

std::string printable(std::string_view text) {
  std::string out;
  for (size_t at = 0, length = 0; at < text.size(); at += length) {
    const std::string shown = visible(text, at, length);
    out.append(text[at] == '\t' ? "\\t" : shown.c_str());
  }
  return out;
}

std::string in_quotes(std::string_view text) {
  constexpr size_t kLongest = 60;
  size_t end = 0, count = 0;
  for (; end < text.size() && count < kLongest; ++count) end += std::max<size_t>(utf8_length(text, end), 1);
  std::string out = "\"";
  out += printable(text.substr(0, end));
  return out.append(end < text.size() ? "...\"" : "\"");
}

std::string quoted_path(std::string_view path) {
  constexpr size_t kLongest = 1000;
  size_t start = path.size() > kLongest ? path.size() - kLongest : 0;
  while (start > 0 && start < path.size() && (static_cast<unsigned char>(path[start]) & 0xc0) == 0x80) ++start;
  std::string out = start > 0 ? "\"..." : "\"";
  out += printable(path.substr(start));
  return out.append("\"");
}

std::string foreign_characters(std::string_view text) {
  struct Foreign {
    std::string_view bytes, meant;
  };
  constexpr Foreign kForeign[] = {
      {"\xe2\x80\x9c", "quotes"},
      {"\xe2\x80\x9d", "quotes"},
      {"\xe2\x80\x9e", "quotes"},
      {"\xe2\x80\x9f", "quotes"},
      {"\xe2\x80\x98", "quotes"},
      {"\xe2\x80\x99", "quotes"},
      {"\xe2\x80\x9a", "quotes"},
      {"\xe2\x80\xb2", "quotes"},
      {"\xe2\x80\xb3", "quotes"},
      {"\xc2\xab", "quotes"},
      {"\xc2\xbb", "quotes"},
      {"'", "quotes"},
      {"`", "quotes"},
      {"\xe2\x88\x92", "minus"},
      {"\xe2\x80\x93", "minus"},
      {"\xe2\x80\x94", "minus"},
  };
  for (size_t at = 0, length = 0; at < text.size(); at += length) {
    length = std::max<size_t>(utf8_length(text, at), 1);
    const std::string_view one = text.substr(at, length);
    const uint32_t code = utf8_length(text, at) > 1 ? code_point(one) : 0;
    if (code == 0xa0) return "it holds a no-break space, U+00A0: write a plain one";
    if (is_unseen(code))
      return "it holds " + unicode_escape(code) + ", which cannot be seen: leave it out, or write a space";
    for (const Foreign& foreign : kForeign) {
      if (foreign.bytes != one) continue;
      const bool quotes = foreign.meant == "quotes";
      return std::string(one) + (quotes ? " is no quote here: write \" around names" : " is no sign here: write -");
    }
  }
  if (text.starts_with("//") || text.starts_with("/*")) return "comments begin with #";
  return {};
}

std::string why_not_text(std::string_view text) {
  if (text.starts_with("\x1f\x8b")) return "it is compressed with gzip";
  constexpr const char* kModel =
      "a glTF model: name its file to render it, place it by Shape \"gltf\", or `whit import` it";
  if (text.starts_with("glTF")) return std::string("it is ") + kModel;
  if (text.starts_with('{')) return std::string("it is JSON, perhaps ") + kModel;
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) return "it is UTF-16 text, not UTF-8";
  if (text.find('\0') != std::string_view::npos) return "it holds binary data";
  // Comments may be in any encoding of old, so bytes that are no UTF-8 weigh less than control characters.
  const std::string_view head = text.substr(0, 4096);
  size_t controls = 0, invalid = 0;
  for (size_t at = 0; at < head.size();) {
    const size_t length = utf8_length(head, at);
    const auto byte = static_cast<unsigned char>(head[at]);
    if (length == 0) ++invalid;
    if (is_control(byte) && !(byte >= '\t' && byte <= '\r')) ++controls;
    at += std::max<size_t>(length, 1);
  }
  const bool binary = 50 * controls > head.size() || 3 * invalid > head.size();
  return binary ? "it holds binary data" : std::string();
}

}  // namespace whit
