// The worker's line to the coordinator: one request at a time, kept until it is answered, over as many connections as that takes.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "common/base/clock.hpp"
#include "common/wire/socket.hpp"
#include "worker/session.hpp"

namespace fracfarm::worker {

class Link {
 public:
  Link(std::filesystem::path farm, wire::KeyPair own, Clock& clock);

  void post(const wire::Request& request);
  std::vector<Event> hear();                               // ReplyCame, RequestRefused, CoordinatorChanged; never blocks
  int descriptor() const;                                  // for poll(2), -1 where there is no connection yet
  double next_try() const;                                 // monotonic s; never where nothing waits for a connection
  const std::string& trouble() const { return trouble_; }  // why there is no connection, in words; empty where there is one

 private:
  void connect();

  std::filesystem::path farm_;
  wire::KeyPair own_;
  Clock& clock_;
  std::optional<wire::Client> client_;
  std::optional<wire::Request> unsent_;  // waits for the first connection
  std::uint64_t epoch_ = 0;
  std::string trouble_;
  std::string refused_here_;  // a request that our own side could not send
  double try_at_ = 0.0;
};

}  // namespace fracfarm::worker
