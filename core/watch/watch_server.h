// The preview's page and what it asks for, on the machine's own address, for whoever has the address alone: it holds 128
// random bits.
//
// Other pages of the same browser can send requests here too. They do not know the token; and what names another host
// (as after a change of what a name stands for), comes from another page or is longer than it need be is refused before
// anything is done. No header lets other pages read an answer.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/watch/preview.h"

namespace whit {

struct WatchRequest {
  int port = 0;            ///< 0 takes a free one.
  std::string reference;   ///< A picture to compare with; "" for none.
  std::string view, ocio;  ///< As for pictures; "" takes the default.
};

class WatchServer {
 public:
  WatchServer(Preview& preview, const WatchRequest& request);
  ~WatchServer();
  WatchServer(const WatchServer&) = delete;
  WatchServer& operator=(const WatchServer&) = delete;

  /// "" or why it does not listen.
  std::string listen();
  /// After listen().
  const std::string& address() const;
  /// Ends all answers, those that go on too.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace whit
