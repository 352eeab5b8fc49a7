// The language server: what the editor has said so far, and a method for each of its messages.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "core/author/workspace.h"
#include "tools/whit/lsp_diagnostics.h"
#include "tools/whit/lsp_stream.h"

namespace whit::lsp {

class Server;

/// A row of the table of methods: a request is answered with what its handler returns.
struct Method {
  const char* name;
  bool request;
  Value (*handle)(Server& server, const Value& params);
};
/// What a server can do for an editor, beside keeping up with its texts.
std::vector<Method> feature_methods();
/// The same as capabilities.
Value feature_capabilities();

/// What the editor understands.
struct Client {
  bool snippets = false;
  bool markdown = false;
  bool nested_symbols = false;
  bool document_changes = false;
};

class Server {
 public:
  explicit Server(MessageWriter& writer);

  /// Answers a message. `is_cancelled` tells of a request whether anybody still waits for the answer.
  void handle(const Value& message, bool is_cancelled);
  /// Whether the editor has said that it ends, and with which exit code.
  bool ended() const { return ended_; }
  int exit_code() const { return shut_down_ ? 0 : 1; }

  // For the handlers.
  author::Workspace workspace;
  Client client;
  /// The file of a parameter "textDocument"; throws a RequestError where the editor has not opened it.
  author::File& file_of(const Value& params);
  std::string uri_of(const author::File& file) const;
  /// What is known to be wrong with a file.
  std::vector<author::Finding> findings_in(const std::string& path);

  // Messages about the server's and the documents' life.
  Value initialize(const Value& params);
  Value shut_down();
  void exit() { ended_ = true; }
  void did_open(const Value& params);
  void did_change(const Value& params);
  void did_save(const Value& params);
  void did_close(const Value& params);
  void did_change_files(const Value& params);

 private:
  void take_client(const Value& capabilities);
  void diagnose(const std::string& changed, bool at_once);
  void publish(const std::string& main, const author::Findings& findings, const lsp::Snapshot& snapshot);
  void publish_file(const std::string& path, const lsp::Snapshot& snapshot);
  void forget(const std::string& main);
  Snapshot snapshot();

  MessageWriter& writer_;
  std::map<std::string, Method> methods_;
  bool initialized_ = false, shut_down_ = false, ended_ = false;
  std::set<std::string> mains_;  ///< The scenes that open files belong to.

  std::mutex findings_mutex_;
  std::map<std::string, author::Findings> findings_;  ///< By main file.
  std::map<std::string, std::string> uris_;           ///< Of open files, by path.
  std::unique_ptr<DiagnosticsWorker> worker_;         ///< Last, so that it ends before what it reports to.
};

/// Paths and the addresses that editors give them.
std::string path_of_uri(const std::string& uri);
std::string uri_of_path(const std::string& path);

Value to_json(author::Position position);
Value range_json(author::Position begin, author::Position end);
author::Position position_of(const Value& json);

}  // namespace whit::lsp
