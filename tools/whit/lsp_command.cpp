// `whit lsp`: the language server, on standard input and output. Nothing but the protocol goes to standard output.

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <iterator>
#include <mutex>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "tools/whit/command_line.h"
#include "tools/whit/commands.h"
#include "tools/whit/lsp_server.h"

namespace whit {
namespace {

using lsp::Incoming;
using lsp::Value;

/// Messages that wait for their turn. They are read as they come, so that one can take back another before its turn.
class Inbox {
 public:
  void put(Incoming incoming) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      note_cancellation(incoming);
      waiting_.push_back(std::move(incoming));
    }
    changed_.notify_one();
  }
  void close() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      closed_ = true;
    }
    changed_.notify_one();
  }
  /// The next message, and whether it has been cancelled; false when there will be none.
  bool take(Incoming& out, bool& is_cancelled) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    if (waiting_.empty()) return false;
    const auto next = waiting_.begin() + static_cast<std::ptrdiff_t>(next_in_turn());
    out = std::move(*next);
    waiting_.erase(next);
    is_cancelled =
        out.message.is_object() && out.message.contains("id") && cancelled_.erase(out.message["id"].dump()) > 0;
    return true;
  }

 private:
  static std::string_view method(const Incoming& incoming) {
    const Value& m = incoming.message;
    const auto found = m.is_object() ? m.find("method") : m.end();
    return m.is_object() && found != m.end() && found->is_string()
               ? std::string_view(found->get_ref<const std::string&>())
               : std::string_view();
  }

  /// What is told of a whole text takes its time: what comes with typing goes first. The answer then tells of the text
  /// as it is by then, which is the one that the editor has.
  size_t next_in_turn() const {
    static constexpr std::string_view kLong[] = {"textDocument/semanticTokens/full", "textDocument/documentSymbol",
                                                 "textDocument/foldingRange", "textDocument/documentColor",
                                                 "textDocument/documentLink"};
    static constexpr std::string_view kFirst[] = {"textDocument/didChange", "textDocument/completion",
                                                  "textDocument/hover", "$/cancelRequest"};
    const auto is_one_of = [](const auto& list, std::string_view name) {
      return std::find(std::begin(list), std::end(list), name) != std::end(list);
    };
    for (size_t i = 0; i < waiting_.size(); ++i) {
      const std::string_view name = method(waiting_[i]);
      if (is_one_of(kLong, name)) continue;
      return is_one_of(kFirst, name) ? i : 0;
    }
    return 0;
  }

  /// Of those that wait alone: an id may be used again.
  void note_cancellation(const Incoming& incoming) {
    const Value& m = incoming.message;
    if (!m.is_object() || m.value("method", Value()) != "$/cancelRequest") return;
    const Value params = m.value("params", Value());
    const Value id = params.is_object() ? params.value("id", Value()) : Value();
    for (const Incoming& other : waiting_) {
      if (other.message.is_object() && other.message.contains("id") && other.message["id"] == id)
        cancelled_.insert(id.dump());
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Incoming> waiting_;
  std::set<std::string> cancelled_;
  bool closed_ = false;
};

/// Whether nothing that comes behind a message is for this server.
bool ends_session(const Incoming& incoming) {
  return incoming.message.is_object() && incoming.message.value("method", Value()) == "exit";
}

void read_all(int descriptor, Inbox& inbox) {
  try {
    lsp::MessageReader reader(descriptor);
    while (std::optional<Incoming> incoming = reader.read()) {
      const bool last = ends_session(*incoming);
      inbox.put(std::move(*incoming));
      if (last) break;
    }
  } catch (const std::bad_alloc&) {
    // Where the next message begins is not known any more: the session ends here.
  }
  inbox.close();
}

int serve(int in, int out) {
  lsp::MessageWriter writer(out);
  lsp::Server server(writer);
  Inbox inbox;
  std::thread reader([&] { read_all(in, inbox); });
  Incoming incoming;
  bool is_cancelled = false;
  while (!server.ended() && inbox.take(incoming, is_cancelled)) {
    if (incoming.problem) writer.fail(nullptr, *incoming.problem);
    else server.handle(incoming.message, is_cancelled);
  }
  reader.join();
  return server.exit_code();
}

}  // namespace

int lsp_command(const Arguments& args) {
  bool stdio = false;
  const CommandLine command{"whit lsp",
                            "Serves an editor: the language server protocol 3.17 on standard input and output.",
                            {{"--stdio", &stdio, "What it does anyway; some editors ask for it"}}};
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  std::signal(SIGPIPE, SIG_IGN);
  // Whatever a library may print by mistake shall not get among the messages.
  const int out = ::dup(STDOUT_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  return serve(STDIN_FILENO, out);
}

}  // namespace whit
