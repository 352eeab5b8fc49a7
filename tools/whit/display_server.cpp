#include "tools/whit/display_server.h"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>

namespace whit {
namespace {

static_assert(std::endian::native == std::endian::little, "the protocol is little-endian");

enum class Message : uint8_t { UpdateImage = 3, CreateImage = 4 };

/// A message under construction: four bytes of length, then the values one after the other.
class Packet {
 public:
  explicit Packet(Message kind) : bytes(sizeof(uint32_t)) { put(static_cast<uint8_t>(kind)); }
  template <class T>
  void put(T value) {
    const auto* from = reinterpret_cast<const char*>(&value);
    bytes.insert(bytes.end(), from, from + sizeof(T));
  }
  void put(const std::string& text) { bytes.insert(bytes.end(), text.c_str(), text.c_str() + text.size() + 1); }
  std::vector<char> bytes;
};

/// What nobody takes for so long stops no render any longer.
constexpr timeval kPatience{5, 0};
constexpr const char* kChannels[3] = {"R", "G", "B"};

}  // namespace

DisplayServer::~DisplayServer() {
  if (socket_ >= 0) ::close(socket_);
}

std::string DisplayServer::connect(const std::string& address) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos) return fmt::format("--display-server takes host:port, not \"{}\"", address);
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  const int problem = getaddrinfo(address.substr(0, colon).c_str(), address.substr(colon + 1).c_str(), &hints, &found);
  if (problem != 0) return fmt::format("cannot find display server {}: {}", address, gai_strerror(problem));
  std::string why = "no address";
  for (const addrinfo* a = found; a && socket_ < 0; a = a->ai_next) {
    const int s = ::socket(a->ai_family, a->ai_socktype, a->ai_protocol);
    // The time to send has connecting in it (socket(7)).
    if (s >= 0) ::setsockopt(s, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
    if (s >= 0 && ::connect(s, a->ai_addr, a->ai_addrlen) == 0) {
      socket_ = s;
    } else {
      why = errno == EINPROGRESS ? "it does not answer" : std::strerror(errno);
      if (s >= 0) ::close(s);
    }
  }
  freeaddrinfo(found);
  return socket_ >= 0 ? "" : fmt::format("cannot reach display server {}: {}", address, why);
}

void DisplayServer::create(const std::string& name, Vec2i size) {
  std::lock_guard lock(mutex_);
  name_ = name;
  Packet p(Message::CreateImage);
  p.put(uint8_t{1});  // Bring the window to the front.
  p.put(name_);
  p.put(int32_t{size.x});
  p.put(int32_t{size.y});
  p.put(int32_t{3});
  for (const char* c : kChannels) p.put(std::string(c));
  send_message(p.bytes);
}

void DisplayServer::go_on(const std::string& name) {
  std::lock_guard lock(mutex_);
  name_ = name;
}

void DisplayServer::update(const Box2i& window, std::span<const float> rgb) {
  std::lock_guard lock(mutex_);
  if (socket_ < 0) return;
  for (size_t c = 0; c < 3; ++c) {
    Packet p(Message::UpdateImage);
    p.put(uint8_t{0});
    p.put(name_);
    p.put(std::string(kChannels[c]));
    p.put(int32_t{window.min.x});
    p.put(int32_t{window.min.y});
    p.put(int32_t{window.max.x - window.min.x});
    p.put(int32_t{window.max.y - window.min.y});
    for (size_t i = c; i < rgb.size(); i += 3) p.put(rgb[i]);
    send_message(p.bytes);
  }
}

void DisplayServer::send_message(std::vector<char>& message) {
  const auto length = static_cast<uint32_t>(message.size());
  std::memcpy(message.data(), &length, sizeof(length));
  for (size_t sent = 0; socket_ >= 0 && sent < message.size();) {
    const ssize_t n = ::send(socket_, message.data() + sent, message.size() - sent, MSG_NOSIGNAL);
    if (n > 0) {
      sent += static_cast<size_t>(n);
    } else if (errno != EINTR) {
      // The viewer is gone; the render goes on.
      ::close(socket_);
      socket_ = -1;
    }
  }
}

}  // namespace whit
