#include "tools/whit/lsp_stream.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <utility>

namespace whit::lsp {
namespace {

constexpr size_t kLongestHeader = 4096, kLargestMessage = size_t{1} << 28;
/// A length beyond this is no length, and what follows is not skipped.
constexpr size_t kLargestSkipped = size_t{1} << 32;

/// The value of a header of this name (its case does not matter), or nothing.
std::optional<std::string_view> header_value(std::string_view line, std::string_view name) {
  const size_t colon = line.find(':');
  if (colon != name.size()) return std::nullopt;
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  if (!std::equal(name.begin(), name.end(), line.begin(), [&](char n, char l) { return same(l, n); }))
    return std::nullopt;
  line.remove_prefix(colon + 1);
  while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
  while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
  return line;
}

std::optional<size_t> number(std::string_view text) {
  size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value > kLargestSkipped) return std::nullopt;
  return value;
}

Incoming problem(ErrorCode code, std::string message) { return {nullptr, RequestError{code, std::move(message)}}; }

}  // namespace

bool MessageReader::fill() {
  buffer_.erase(0, used_);
  used_ = 0;
  const size_t before = buffer_.size();
  buffer_.resize(before + (size_t{1} << 16));
  ssize_t got = 0;
  do got = ::read(descriptor_, buffer_.data() + before, buffer_.size() - before);
  while (got < 0 && errno == EINTR);
  buffer_.resize(before + static_cast<size_t>(std::max<ssize_t>(got, 0)));
  return got > 0;
}

/// A line without its end; of one that is too long for a header the beginning.
bool MessageReader::read_line(std::string& line, bool& too_long) {
  line.clear(), too_long = false;
  for (;;) {
    const size_t end = buffer_.find('\n', used_);
    const size_t stop = end == std::string::npos ? buffer_.size() : end;
    line.append(buffer_, used_, std::min(stop - used_, kLongestHeader));
    used_ = stop;
    if (line.size() > kLongestHeader) line.resize(kLongestHeader), too_long = true;
    if (end != std::string::npos) break;
    if (!fill()) return false;
  }
  ++used_;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return true;
}

bool MessageReader::read_bytes(size_t count, std::string& out) {
  while (buffer_.size() - used_ < count) {
    if (!fill()) return false;
  }
  out = buffer_.substr(used_, count);
  used_ += count;
  return true;
}

bool MessageReader::skip_bytes(size_t count) {
  while (buffer_.size() - used_ < count) {
    count -= buffer_.size() - used_;
    used_ = buffer_.size();
    if (!fill()) return false;
  }
  used_ += count;
  return true;
}

/// The length of the message behind a header; nothing where there is no header.
std::optional<size_t> MessageReader::read_header(bool& ended) {
  std::optional<size_t> length;
  bool garbage = false, too_long = false;
  std::string line;
  for (;;) {
    ended = !read_line(line, too_long);
    if (ended || (line.empty() && (length || garbage))) return length;
    if (line.empty()) continue;
    if (const auto value = header_value(line, "content-length"); value && !too_long) {
      length = number(*value);
      garbage = !length;
    } else if (too_long || !header_value(line, "content-type")) {
      garbage = garbage || !length;
    }
  }
}

/// In what is no header it goes on line by line to the next one, having said so once.
std::optional<Incoming> MessageReader::read() {
  for (;;) {
    bool ended = false;
    const std::optional<size_t> length = read_header(ended);
    if (ended) return std::nullopt;
    if (!length) {
      if (std::exchange(lost_, true)) continue;
      return problem(ErrorCode::ParseError, "a message begins with a header \"Content-Length: N\"");
    }
    lost_ = false;
    if (*length > kLargestMessage) {
      if (!skip_bytes(*length)) return std::nullopt;
      return problem(ErrorCode::InvalidRequest, "the message has more than 256 MiB");
    }
    std::string body;
    if (!read_bytes(*length, body)) return std::nullopt;
    Value message = Value::parse(body, nullptr, false);
    if (message.is_discarded()) return problem(ErrorCode::ParseError, "the message is not JSON");
    return Incoming{std::move(message), std::nullopt};
  }
}

void MessageWriter::write(const Value& message) {
  const std::string body = message.dump(-1, ' ', false, Value::error_handler_t::replace);
  const std::string text = fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
  const std::lock_guard<std::mutex> lock(mutex_);
  for (size_t done = 0; done < text.size();) {
    const ssize_t put = ::write(descriptor_, text.data() + done, text.size() - done);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return;  // Nobody listens any more; the end of the input tells.
    done += static_cast<size_t>(put);
  }
}

void MessageWriter::notify(const std::string& method, Value params) {
  write({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
}

void MessageWriter::answer(const Value& id, Value result) {
  write({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
}

void MessageWriter::fail(const Value& id, const RequestError& error) {
  write({{"jsonrpc", "2.0"},
         {"id", id},
         {"error", {{"code", static_cast<int>(error.code)}, {"message", error.message}}}});
}

}  // namespace whit::lsp
