// The server, by cpp-httplib. GET and POST alone are answered, and no connection lives longer than its request.
#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <ctime>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/watch/http/module.h"

namespace whit {
namespace {

/// Threads for requests, at most. Each page that is open holds one, for its events; each request that somebody has begun
/// and not ended holds one for as long as is waited for the rest.
constexpr size_t kThreads = 512;
/// Whoever asks is on the same machine, and has no reason to stop in the middle for longer.
constexpr time_t kReadSeconds = 2;

/// Threads that are made when all others are busy.
class Threads final : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    if (tasks_.size() > idle_ && threads_.size() < kThreads) add();
    changed_.notify_one();
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void add() {
    try {
      threads_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
      if (threads_.empty()) throw;  // Otherwise one of them will be free in time.
    }
  }

  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      ++idle_;
      changed_.wait(lock, [this] { return ending_ || !tasks_.empty(); });
      --idle_;
      if (tasks_.empty()) return;
      const std::function<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::vector<std::thread> threads_;
  size_t idle_ = 0;
  bool ending_ = false;
};

class Server final : public HttpServer {
 public:
  Server(HttpHandler handler, HttpCheck check, std::vector<std::pair<std::string, std::string>> headers_of_all)
      : handler_(std::move(handler)), check_(std::move(check)) {
    httplib::Headers headers;
    for (auto& header : headers_of_all) headers.insert(std::move(header));
    server_.set_default_headers(std::move(headers));
    server_.new_task_queue = [] { return new Threads; };
    server_.set_keep_alive_max_count(1);
    server_.set_keep_alive_timeout(kReadSeconds);
    server_.set_read_timeout(kReadSeconds);
    server_.set_tcp_nodelay(true);
    // Without SO_REUSEPORT, which would let two servers have one port.
    server_.set_socket_options([](socket_t sock) {
      const int yes = 1;
      setsockopt(sock, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_pre_routing_handler(
        [this](const httplib::Request& request, httplib::Response& response) { return answer(request, response); });
    server_.set_expect_100_continue_handler([](const httplib::Request&, httplib::Response&) { return 417; });
    // Everything without a body is answered before paths are matched by a regular expression.
    server_.Post("[^]*",
                 [this](const httplib::Request& request, httplib::Response& response) { reply(request, response); });
  }

  int bind(int port) override {
    constexpr const char* kHere = "127.0.0.1";
    if (port == 0) return std::max(server_.bind_to_any_port(kHere), 0);
    return server_.bind_to_port(kHere, port) ? port : 0;
  }
  void run() override {
    server_.listen_after_bind();
    ended_ = true;
  }
  void stop() override {
    // One that has not begun would not be stopped, and then begin.
    while (!server_.is_running() && !ended_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    server_.stop();
  }

 private:
  using Handled = httplib::Server::HandlerResponse;

  static HttpRequest asked_of(const httplib::Request& request) {
    HttpRequest asked{request.method,
                      request.path,
                      request.get_header_value("Host"),
                      request.get_header_value("Origin"),
                      request.get_header_value("Content-Type"),
                      {},
                      request.body};
    // Of several hosts none is to be believed.
    if (request.get_header_value_count("Host") != 1) asked.host.clear();
    for (const auto& [name, value] : request.params) asked.query.emplace(name, value);
    return asked;
  }

  /// Before a body is read: refuses what has no length or is none of its business, and answers what has no body.
  Handled answer(const httplib::Request& request, httplib::Response& response) const {
    const bool post = request.method == "POST";
    const size_t length = request.get_header_value<uint64_t>("Content-Length");
    if (request.method != "GET" && !post) {
      response.status = 405;
    } else if (request.has_header("Transfer-Encoding") || (post && !request.has_header("Content-Length"))) {
      response.status = 411;
    } else if (std::optional<HttpReply> refused = check_(asked_of(request), length)) {
      send(std::move(*refused), response);
    } else if (post) {
      return Handled::Unhandled;
    } else {
      reply(request, response);
    }
    return Handled::Handled;
  }

  void reply(const httplib::Request& request, httplib::Response& response) const {
    send(handler_(asked_of(request)), response);
  }

  static void send(HttpReply made, httplib::Response& response) {
    response.status = made.status;
    for (const auto& [name, value] : made.headers) {
      response.headers.erase(name);
      response.set_header(name, value);
    }
    if (!made.stream) {
      response.set_content(made.body, made.type);
      return;
    }
    response.set_chunked_content_provider(made.type,
                                          [stream = std::move(made.stream)](size_t, httplib::DataSink& sink) {
                                            std::string piece;
                                            if (!stream(piece)) {
                                              sink.done();
                                              return true;
                                            }
                                            return sink.write(piece.data(), piece.size());
                                          });
  }

  HttpHandler handler_;
  HttpCheck check_;
  httplib::Server server_;
  std::atomic<bool> ended_{false};
};

std::unique_ptr<HttpServer> make(HttpHandler handler, HttpCheck check,
                                 std::vector<std::pair<std::string, std::string>> headers_of_all) {
  return std::make_unique<Server>(std::move(handler), std::move(check), std::move(headers_of_all));
}

}  // namespace
}  // namespace whit

// What the module hands out under a name that dlsym() can find.
extern "C" __attribute__((visibility("default"))) const whit::HttpModule whit_http{whit::make};
