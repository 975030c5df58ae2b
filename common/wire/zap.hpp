// Who may connect: the ZAP handler (ZeroMQ RFC 27) of a CURVE server, in a thread of its own. It must never end before its server:
// without it new connections hang for ever, so whoever owns it watches alive().
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <zmq.hpp>

namespace fracfarm::wire {

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
  std::string name_of_key(const std::string& public_key);  // empty: not allowed
  void reload();

  std::filesystem::path farm_;
  zmq::socket_t socket_;
  std::map<std::string, std::string> names_;  // public key (Z85) to name
  std::filesystem::file_time_type read_at_{};
  std::atomic<bool> stop_{false};
  std::atomic<bool> alive_{true};
  std::atomic<std::uint64_t> refused_{0};
  std::thread thread_;
};

}  // namespace fracfarm::wire
