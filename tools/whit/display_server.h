// Sends the picture, tile by tile while it is made, to an image viewer that speaks tev's protocol.
//
// Source: the IPC section of tev's documentation (https://github.com/Tom94/tev), the messages that pbrt-v4 uses too.
#pragma once

#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec.h"

namespace whit {

/// A connection to a viewer. All calls may come from any thread. After the first failure nothing more is sent, and a viewer
/// that takes nothing for some seconds has failed.
class DisplayServer {
 public:
  DisplayServer() = default;
  ~DisplayServer();
  DisplayServer(const DisplayServer&) = delete;
  DisplayServer& operator=(const DisplayServer&) = delete;

  /// Connects to "host:port". Returns "" or what went wrong.
  std::string connect(const std::string& address);

  /// Opens a picture of that name and size in the viewer.
  void create(const std::string& name, Vec2i size);
  /// The same with one that an earlier connection opened.
  void go_on(const std::string& name);

  /// Replaces a rectangle of it: linear RGB, row by row.
  void update(const Box2i& window, std::span<const float> rgb);

 private:
  void send_message(std::vector<char>& message);
  std::mutex mutex_;
  int socket_ = -1;
  std::string name_;
};

}  // namespace whit
