// What whit asks of cpp-httplib: a server that listens on the machine's own address alone. It lives in a module of its
// own, whit_http.so, which is loaded when first needed: it brings the libraries of OpenSSL along, which `whit render` would
// load for nothing.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace whit {

struct HttpRequest {
  std::string method, path, host, origin, type;  ///< `path` decoded, without what is behind ?.
  std::map<std::string, std::string> query;
  std::string body;
};

struct HttpReply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8", body;
  std::vector<std::pair<std::string, std::string>> headers;
  /// Instead of the body: called again and again for what comes next, until it returns false.
  std::function<bool(std::string& piece)> stream;
};

/// Called from several threads.
using HttpHandler = std::function<HttpReply(const HttpRequest&)>;
/// Asked before the body of a request is read, which has so many bytes: the reply to one that is not to be read at all.
using HttpCheck = std::function<std::optional<HttpReply>(const HttpRequest&, size_t length)>;

class HttpServer {
 public:
  virtual ~HttpServer() = default;
  /// Of 127.0.0.1; port 0 takes a free one. Returns the port, or 0 when it is not to be had.
  virtual int bind(int port) = 0;
  /// Answers until stop(), which any thread may call.
  virtual void run() = 0;
  virtual void stop() = 0;
};

/// The module's function.
struct HttpModule {
  std::unique_ptr<HttpServer> (*make)(HttpHandler handler, HttpCheck check,
                                      std::vector<std::pair<std::string, std::string>> headers_of_all);
};

/// The module, loaded by the first call of the process (any thread). Throws std::runtime_error when it is missing.
const HttpModule& http_module();

}  // namespace whit
