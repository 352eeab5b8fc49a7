// Messages of the language server protocol on file descriptors: a header, an empty line, JSON.
#pragma once

#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace whit::lsp {

using Value = nlohmann::json;

/// Codes of JSON-RPC and of the protocol.
enum class ErrorCode : int {
  ParseError = -32700,
  InvalidRequest = -32600,
  MethodNotFound = -32601,
  InvalidParams = -32602,
  InternalError = -32603,
  NotInitialized = -32002,
  RequestFailed = -32803,
  RequestCancelled = -32800,
};

/// What a request is answered with that cannot be fulfilled.
struct RequestError {
  ErrorCode code = ErrorCode::RequestFailed;
  std::string message;
};

/// A message as it came in, or why there is none in what came in.
struct Incoming {
  Value message;
  std::optional<RequestError> problem;
};

/// Reads messages. One thread reads.
class MessageReader {
 public:
  explicit MessageReader(int descriptor) : descriptor_(descriptor) {}
  /// The next message; nothing at the end of the input.
  std::optional<Incoming> read();

 private:
  bool fill();
  bool read_line(std::string& line, bool& too_long);
  bool read_bytes(size_t count, std::string& out);
  bool skip_bytes(size_t count);
  std::optional<size_t> read_header(bool& ended);

  int descriptor_;
  std::string buffer_;
  size_t used_ = 0;
  bool lost_ = false;  ///< In what is no header, of which has been said so.
};

/// Writes messages, each whole, from any thread.
class MessageWriter {
 public:
  explicit MessageWriter(int descriptor) : descriptor_(descriptor) {}
  void notify(const std::string& method, Value params);
  void answer(const Value& id, Value result);
  void fail(const Value& id, const RequestError& error);

 private:
  void write(const Value& message);

  int descriptor_;
  std::mutex mutex_;
};

}  // namespace whit::lsp
