// The only door to ZeroMQ. Server: ROUTER (mandatory, no handover) with CURVE and a supervised ZAP thread. Client: DEALER, one request at a
// time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "common/wire/keys.hpp"
#include "common/wire/messages.hpp"

namespace fracfarm::wire {

struct Incoming {
  std::string route;  // routing id: where to answer, never who it is
  std::string peer;   // authenticated name of the key (ZAP user id)
  std::string bytes;
};

// Counts of what was thrown away unread, for status.
struct ServerCounts {
  std::uint64_t odd_frames = 0;    // not one frame, or of an unauthenticated peer
  std::uint64_t unsendable = 0;    // replies to peers that were gone or did not read
  std::uint64_t unknown_keys = 0;  // refused handshakes
  std::uint64_t revoked_keys = 0;  // messages of connections whose key was taken away or replaced since; among the odd ones
};

class Server {
 public:
  // endpoint: tcp://host:port, port 0 or * for any. Errors: NODE_LOST with the reason in words.
  static Result<Server> bind(const std::string& endpoint, const std::filesystem::path& farm);
  ~Server();
  Server(Server&&) noexcept;
  Server& operator=(Server&&) noexcept;

  std::string endpoint() const;  // with the real port
  // Waits up to timeout_s for the first message, then takes what is there, at most `max`. Over-long messages are dropped and counted.
  std::vector<Incoming> receive(std::size_t max, double timeout_s);
  bool send(const std::string& route, std::string_view bytes);  // false: the peer is gone or its queue is full
  bool healthy() const;                                         // false where the ZAP thread has ended; the owner must stop
  ServerCounts counts() const;

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

class Client {
 public:
  // Never waits for the coordinator to be there. The endpoint is read again from DIR/endpoint.json, where there is one, at each reconnect.
  static Result<Client> connect(const std::string& endpoint, const std::filesystem::path& farm, const KeyPair& own);
  ~Client();
  Client(Client&&) noexcept;
  Client& operator=(Client&&) noexcept;

  // Sends and waits; resends under the same request id after silence, reconnecting; errors: NODE_LOST after timeout_s.
  // A Refusal comes back as BAD_REQUEST.
  Result<Reply> ask(const Request& request, double timeout_s);
  // In two halves, for a loop that must also watch its children: post never blocks; poll gives the reply to the last post, if it is there.
  Result<void> post(const Request& request);
  Result<std::optional<Reply>> poll(double timeout_s);
  int descriptor() const;  // for poll(2); edge-triggered: wait on it only where nothing is readable. Changes at reconnect.
  bool readable() const;
  std::uint64_t epoch() const;  // that DIR/endpoint.json stated at the last (re)connect, 0 where there was none

 private:
  struct Impl;
  explicit Client(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace fracfarm::wire
