#include "tools/whit/lsp_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "core/base/file_names.h"
#include "tools/whit/version.h"

namespace whit::lsp {
namespace {

using author::File;
using author::Finding;
using author::Position;

/// A handler of a notification, which has no answer.
template <void (Server::*handler)(const Value&)>
Value noted(Server& server, const Value& params) {
  (server.*handler)(params);
  return nullptr;
}

std::vector<Method> life_methods() {
  return {
      {"initialize", true, [](Server& s, const Value& p) { return s.initialize(p); }},
      {"initialized", false, [](Server&, const Value&) { return Value(); }},
      {"shutdown", true, [](Server& s, const Value&) { return s.shut_down(); }},
      {"exit", false, [](Server& s, const Value&) { return s.exit(), Value(); }},
      {"textDocument/didOpen", false, noted<&Server::did_open>},
      {"textDocument/didChange", false, noted<&Server::did_change>},
      {"textDocument/didSave", false, noted<&Server::did_save>},
      {"textDocument/didClose", false, noted<&Server::did_close>},
      {"workspace/didChangeWatchedFiles", false, noted<&Server::did_change_files>},
      {"workspace/didChangeConfiguration", false, [](Server&, const Value&) { return Value(); }},
      {"$/cancelRequest", false, [](Server&, const Value&) { return Value(); }},
      {"$/setTrace", false, [](Server&, const Value&) { return Value(); }},
  };
}

/// A member by the path to it, or null: {"a": {"b": 1}} has "a/b".
const Value& member(const Value& object, std::initializer_list<const char*> path) {
  static const Value none;
  const Value* at = &object;
  for (const char* name : path) {
    if (!at->is_object()) return none;
    const auto found = at->find(name);
    if (found == at->end()) return none;
    at = &*found;
  }
  return *at;
}

/// A whole number, be it written as 3.0; throws a RequestError for any other, of which some fit no integer.
int64_t whole_number(const Value& value) {
  constexpr double kMost = 9007199254740992;  // 2^53: above it doubles skip whole numbers.
  if (value.is_number_integer()) return value.get<int64_t>();
  const double number = value.is_number_float() ? value.get<double>() : 0.5;
  if (!(std::abs(number) <= kMost) || number != std::trunc(number))
    throw RequestError{ErrorCode::InvalidParams, value.dump() + " stands where a whole number should"};
  return static_cast<int64_t>(number);
}

bool says_yes(const Value& value) { return value.is_boolean() && value.get<bool>(); }

bool lists(const Value& array, const char* word) {
  return array.is_array() && std::any_of(array.begin(), array.end(), [&](const Value& v) { return v == word; });
}

/// As the protocol numbers them; the last is information.
int severity_number(Severity severity) {
  switch (severity) {
    case Severity::Error: return 1;
    case Severity::Warning: return 2;
    case Severity::Note: break;
  }
  return 3;
}

Value finding_json(const Finding& f) {
  Value out{{"range", range_json(f.begin, f.end)},
            {"severity", severity_number(f.severity)},
            {"source", "whit"},
            {"message", f.remedy.empty() ? f.message : f.message + "\n" + f.remedy}};
  if (!f.name.empty()) out["code"] = f.name;
  if (f.other) {
    out["relatedInformation"] = {
        {{"location", {{"uri", uri_of_path(f.other->path)}, {"range", range_json(f.other->begin, f.other->end)}}},
         {"message", "this is about it too"}}};
  }
  return out;
}

bool same(const Finding& a, const Finding& b) {
  return a.begin == b.begin && a.message == b.message && a.severity == b.severity;
}

}  // namespace

Value to_json(Position p) { return {{"line", p.line}, {"character", p.character}}; }
Value range_json(Position begin, Position end) { return {{"start", to_json(begin)}, {"end", to_json(end)}}; }

Position position_of(const Value& json) {
  const auto number = [&](const char* name) {
    const int64_t value = whole_number(json.at(name));
    if (value < 0) throw RequestError{ErrorCode::InvalidParams, "positions are counted from 0"};
    return static_cast<uint32_t>(std::min<int64_t>(value, 0xffffffff));
  };
  return {number("line"), number("character")};
}

std::string path_of_uri(const std::string& uri) {
  if (!uri.starts_with("file://")) return uri;
  // Behind the name of a host, which is this one.
  const size_t at = uri.find('/', 7);
  return at == std::string::npos ? std::string() : percent_decoded(std::string_view(uri).substr(at));
}

std::string uri_of_path(const std::string& path) {
  if (path.empty() || path.front() != '/') return path;
  return "file://" + percent_encoded(path);
}

Server::Server(MessageWriter& writer) : writer_(writer) {
  for (const Method& m : life_methods()) methods_.emplace(m.name, m);
  for (const Method& m : feature_methods()) methods_.emplace(m.name, m);
  worker_ = std::make_unique<DiagnosticsWorker>([this](const std::string& main, const author::Findings& findings,
                                                       const lsp::Snapshot& texts) { publish(main, findings, texts); });
}

// ------------------------------------------------------------------------------------------------- messages

void Server::handle(const Value& message, bool is_cancelled) {
  const bool named = message.is_object() && message.contains("method") && message["method"].is_string();
  const Value id = message.is_object() ? message.value("id", Value()) : Value();
  const bool can_answer = id.is_string() || id.is_number_integer();
  if (!named) {
    const bool is_answer = message.is_object() && (message.contains("result") || message.contains("error"));
    if (!is_answer) writer_.fail(can_answer ? id : Value(), {ErrorCode::InvalidRequest, "the message has no method"});
    return;
  }
  const auto name = message["method"].get<std::string>();
  const bool is_request = message.contains("id");
  const auto refuse = [&](const RequestError& error) {
    if (is_request) writer_.fail(can_answer ? id : Value(), error);
  };
  if (is_request && !can_answer) return refuse({ErrorCode::InvalidRequest, "an id is a number or a string"});
  const auto found = methods_.find(name);
  if (!initialized_ && name != "initialize" && name != "exit")
    return refuse({ErrorCode::NotInitialized, "the first request is initialize"});
  if (shut_down_ && name != "exit") return refuse({ErrorCode::InvalidRequest, "the server has been shut down"});
  if (found == methods_.end() || found->second.request != is_request)
    return refuse({ErrorCode::MethodNotFound, "there is no method " + name});
  if (is_cancelled) return refuse({ErrorCode::RequestCancelled, "cancelled"});
  try {
    workspace.look_again();
    static const Value none = Value::object();
    const auto params = message.find("params");
    Value result = found->second.handle(*this, params == message.end() ? none : *params);
    if (is_request) writer_.answer(id, std::move(result));
  } catch (const RequestError& error) { refuse(error); } catch (const Value::exception&) {
    refuse({ErrorCode::InvalidParams, "the parameters of " + name + " are not as the protocol has them"});
  } catch (const std::exception& e) { refuse({ErrorCode::InternalError, e.what()}); }
}

void Server::take_client(const Value& capabilities) {
  const Value& text = member(capabilities, {"textDocument"});
  client.snippets = says_yes(member(text, {"completion", "completionItem", "snippetSupport"}));
  client.markdown = lists(member(text, {"hover", "contentFormat"}), "markdown");
  client.nested_symbols = says_yes(member(text, {"documentSymbol", "hierarchicalDocumentSymbolSupport"}));
  client.document_changes = says_yes(member(capabilities, {"workspace", "workspaceEdit", "documentChanges"}));
  const bool utf8 = lists(member(capabilities, {"general", "positionEncodings"}), "utf-8");
  workspace.encoding = utf8 ? author::Encoding::Utf8 : author::Encoding::Utf16;
}

Value Server::initialize(const Value& params) {
  if (std::exchange(initialized_, true)) throw RequestError{ErrorCode::InvalidRequest, "initialize is sent once"};
  take_client(member(params, {"capabilities"}));
  const auto add_folder = [this](const Value& uri) {
    if (uri.is_string()) workspace.folders.push_back(canonical_path(path_of_uri(uri.get<std::string>())));
  };
  const Value& folders = member(params, {"workspaceFolders"});
  for (const Value& folder : folders.is_array() ? folders : Value::array()) add_folder(member(folder, {"uri"}));
  if (workspace.folders.empty()) add_folder(member(params, {"rootUri"}));
  Value capabilities = feature_capabilities();
  capabilities["positionEncoding"] = workspace.encoding == author::Encoding::Utf8 ? "utf-8" : "utf-16";
  capabilities["textDocumentSync"] = {{"openClose", true}, {"change", 2}, {"save", {{"includeText", false}}}};
  return {{"capabilities", std::move(capabilities)}, {"serverInfo", {{"name", "whit"}, {"version", version()}}}};
}

Value Server::shut_down() {
  shut_down_ = true;
  return nullptr;
}

// ------------------------------------------------------------------------------------------------- documents

File& Server::file_of(const Value& params) {
  const auto uri = params.at("textDocument").at("uri").get<std::string>();
  for (File* file : workspace.open_files()) {
    if (file->uri == uri) return *file;
  }
  throw RequestError{ErrorCode::InvalidParams, "not open: " + uri};
}

std::string Server::uri_of(const File& file) const { return file.uri.empty() ? uri_of_path(file.path) : file.uri; }

void Server::did_open(const Value& params) {
  const Value& document = params.at("textDocument");
  const auto uri = document.at("uri").get<std::string>();
  File& file = workspace.open(path_of_uri(uri), uri, document.at("text").get<std::string>(),
                              document.contains("version") ? whole_number(document["version"]) : 0);
  diagnose(file.path, true);
}

void Server::did_change(const Value& params) {
  File& file = file_of(params);
  const Value& version = params.at("textDocument").value("version", Value());
  if (version.is_number_integer()) file.version = version.get<int64_t>();
  for (const Value& change : params.at("contentChanges")) {
    const auto text = change.at("text").get<std::string>();
    if (change.contains("range"))
      workspace.change(file, position_of(change["range"].at("start")), position_of(change["range"].at("end")), text);
    else workspace.replace(file, text);
  }
  diagnose(file.path, false);
}

void Server::did_save(const Value& params) {
  workspace.refresh();
  diagnose(file_of(params).path, true);
}

void Server::did_close(const Value& params) {
  File& file = file_of(params);
  const std::string path = file.path;
  workspace.close(file);
  diagnose(path, true);
}

/// Pictures and meshes may be there now that were not.
void Server::did_change_files(const Value&) {
  workspace.refresh();
  for (File* file : workspace.open_files()) diagnose(file->path, true);
}

// ----------------------------------------------------------------------------------------------- diagnostics

Snapshot Server::snapshot() {
  Snapshot out;
  out.texts = workspace.open_texts();
  for (const File* file : workspace.open_files()) out.versions[file->path] = file->version;
  return out;
}

/// Has every scene diagnosed of which a file is part, and drops those that no open file belongs to any more.
void Server::diagnose(const std::string& changed, bool at_once) {
  std::set<std::string> mains, affected;
  {
    const std::lock_guard<std::mutex> lock(findings_mutex_);
    uris_.clear();
    for (const File* file : workspace.open_files()) uris_[file->path] = file->uri;
  }
  for (File* file : workspace.open_files()) {
    File* main = workspace.main_of(*file);
    if (!mains.insert(main->path).second) continue;
    const std::vector<File*> files = workspace.files_of(*main);
    const bool is_part = std::any_of(files.begin(), files.end(), [&](const File* f) { return f->path == changed; });
    if (is_part || mains_.count(main->path) == 0) affected.insert(main->path);
  }
  for (const std::string& old : mains_) {
    if (mains.count(old) == 0) forget(old);
  }
  mains_ = std::move(mains);
  if (affected.empty()) return;
  const Snapshot now = snapshot();
  for (const std::string& main : affected) worker_->diagnose(main, now, workspace.encoding, at_once);
}

void Server::forget(const std::string& main) {
  worker_->forget(main);
  publish(main, {}, snapshot());
  const std::lock_guard<std::mutex> lock(findings_mutex_);
  findings_.erase(main);
}

void Server::publish(const std::string& main, const author::Findings& findings, const lsp::Snapshot& texts) {
  const std::lock_guard<std::mutex> lock(findings_mutex_);
  std::set<std::string> paths;
  for (const author::Findings* all : {&std::as_const(findings_[main]), &findings}) {
    for (const auto& [path, found] : *all) paths.insert(path);
  }
  findings_[main] = findings;
  for (const std::string& path : paths) publish_file(path, texts);
}

/// What all scenes that a file is part of say of it, each once.
void Server::publish_file(const std::string& path, const lsp::Snapshot& texts) {
  std::vector<Finding> all;
  for (const auto& [main, findings] : findings_) {
    const auto found = findings.find(path);
    if (found == findings.end()) continue;
    const size_t others = all.size();
    for (const Finding& f : found->second) {
      const auto end = all.begin() + static_cast<std::ptrdiff_t>(others);
      if (std::none_of(all.begin(), end, [&](const Finding& o) { return same(o, f); })) all.push_back(f);
    }
  }
  Value diagnostics = Value::array();
  for (const Finding& f : all) diagnostics.push_back(finding_json(f));
  const auto uri = uris_.find(path);
  Value params{{"uri", uri == uris_.end() ? uri_of_path(path) : uri->second}, {"diagnostics", std::move(diagnostics)}};
  if (const auto version = texts.versions.find(path); version != texts.versions.end())
    params["version"] = version->second;
  writer_.notify("textDocument/publishDiagnostics", std::move(params));
}

std::vector<Finding> Server::findings_in(const std::string& path) {
  const std::lock_guard<std::mutex> lock(findings_mutex_);
  std::vector<Finding> all;
  for (const auto& [main, findings] : findings_) {
    const auto found = findings.find(path);
    if (found != findings.end()) all.insert(all.end(), found->second.begin(), found->second.end());
  }
  return all;
}

}  // namespace whit::lsp
