// Who may connect: the ZAP handler (ZeroMQ RFC 27) of a CURVE server, in a thread of its own. It must never end before its server:
// without it new connections hang for ever, so whoever owns it watches alive().
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <thread>
#include <zmq.hpp>

#include "common/wire/admission.hpp"

namespace fracfarm::wire {

// What a connection's messages carry as their user id: who it is, and by which key, so that a key which is taken away or replaced while the
// connection lasts is known by every message.
inline constexpr std::size_t user_key_length = 40;  // Z85
inline std::string user_id(const std::string& name, const std::string& public_key) { return name + ' ' + public_key; }

class ZapHandler {
 public:
  // Binds at once (throws zmq::error_t), so that no handshake can come before it listens.
  ZapHandler(zmq::context_t& context, std::filesystem::path farm);
  ~ZapHandler();
  ZapHandler(const ZapHandler&) = delete;
  ZapHandler& operator=(const ZapHandler&) = delete;

  bool alive() const { return alive_; }
  std::uint64_t refused() const { return refused_; }

 private:
  void serve();
  void answer_one();

  Admission admission_;
  zmq::socket_t socket_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> alive_{true};
  std::atomic<std::uint64_t> refused_{0};
  std::thread thread_;
};

}  // namespace fracfarm::wire
