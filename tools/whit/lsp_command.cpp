// `whit lsp`: the language server, on standard input and output. Nothing but the protocol goes to standard output.

#include <unistd.h>

#include <csignal>
#include <deque>
#include <set>
#include <string>
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
    out = std::move(waiting_.front());
    waiting_.pop_front();
    is_cancelled =
        out.message.is_object() && out.message.contains("id") && cancelled_.erase(out.message["id"].dump()) > 0;
    return true;
  }

 private:
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
  lsp::MessageReader reader(descriptor);
  while (std::optional<Incoming> incoming = reader.read()) {
    const bool last = ends_session(*incoming);
    inbox.put(std::move(*incoming));
    if (last) break;
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
