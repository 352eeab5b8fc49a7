#include <algorithm>
#include <cstdlib>

#include "tests/fuzz/shared/json_mutator.h"
#include "tests/fuzz/shared/scene_mutator.h"

namespace whit::fuzz {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kMethods[] = {"initialize",
                                         "initialized",
                                         "shutdown",
                                         "exit",
                                         "textDocument/didOpen",
                                         "textDocument/didChange",
                                         "textDocument/didSave",
                                         "textDocument/didClose",
                                         "workspace/didChangeWatchedFiles",
                                         "textDocument/completion",
                                         "textDocument/hover",
                                         "textDocument/definition",
                                         "textDocument/references",
                                         "textDocument/rename",
                                         "textDocument/prepareRename",
                                         "textDocument/documentSymbol",
                                         "textDocument/foldingRange",
                                         "textDocument/semanticTokens/full",
                                         "textDocument/documentColor",
                                         "textDocument/colorPresentation",
                                         "textDocument/formatting",
                                         "textDocument/codeAction",
                                         "textDocument/documentLink",
                                         "textDocument/documentHighlight",
                                         "textDocument/signatureHelp",
                                         "workspace/symbol",
                                         "$/cancelRequest"};

/// Messages with right headers; what is between them is lost.
std::vector<Json> messages_of(const std::string& stream) {
  constexpr std::string_view kHeader = "Content-Length: ";
  std::vector<Json> all;
  for (size_t at = 0; (at = stream.find(kHeader, at)) != stream.npos;) {
    const size_t length = static_cast<size_t>(std::strtoul(stream.c_str() + at + kHeader.size(), nullptr, 10));
    const size_t body = stream.find("\r\n\r\n", at);
    if (body == stream.npos) break;
    Json message = Json::parse(stream.substr(body + 4, length), nullptr, false);
    if (!message.is_discarded()) all.push_back(std::move(message));
    at = body + 4;
  }
  return all;
}

std::string stream_of(const std::vector<Json>& messages) {
  std::string out;
  for (const Json& m : messages) {
    const std::string body = m.dump(-1, ' ', false, Json::error_handler_t::replace);
    out += "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }
  return out;
}

/// Every text of a scene in a message, changed as such.
void mutate_texts(Json& value, Dice& dice) {
  for (auto& item : value.items()) {
    if (item.value().is_structured()) mutate_texts(item.value(), dice);
    if (item.key() != "text" || !item.value().is_string()) continue;
    std::string text = item.value().get<std::string>();
    const size_t size = text.size();
    text.resize(size + 200);
    text.resize(
        mutate_scene(reinterpret_cast<uint8_t*>(text.data()), size, text.size(), static_cast<unsigned>(dice.next())));
    item.value() = text;
  }
}

void mutate(std::vector<Json>& messages, Dice& dice) {
  if (messages.empty()) return;
  const size_t i = dice.below(messages.size()), j = dice.below(messages.size());
  switch (dice.below(8)) {
    case 0: messages.insert(messages.begin() + static_cast<std::ptrdiff_t>(i), Json(messages[j])); break;
    case 1: std::swap(messages[i], messages[j]); break;
    case 2: messages.erase(messages.begin() + static_cast<std::ptrdiff_t>(i)); break;
    case 3:
      if (messages[i].is_object()) messages[i]["method"] = dice.one_of(kMethods);
      break;
    case 4:
    case 5: mutate_texts(messages[i], dice); break;
    default: mutate_json(messages[i], dice);
  }
}

}  // namespace

size_t mutate_messages(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  Dice dice(seed);
  std::vector<Json> messages = messages_of(text_of(data, size));
  if (messages.empty() || dice.one_in(8)) return LLVMFuzzerMutate(data, size, max_size);
  for (size_t n = 1 + dice.below(4); n > 0; --n) mutate(messages, dice);
  return put_text(stream_of(messages), data, max_size);
}

}  // namespace whit::fuzz
