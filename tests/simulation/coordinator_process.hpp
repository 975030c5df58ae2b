// The coordinator as a process that may die at any call: the real reactor and ledger on the world's disk, and a turn as the serving loop
// has it: requests, timers, commit, and only then the replies.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "coordinator/reactor.hpp"
#include "tests/simulation/world.hpp"

namespace fracfarm::simulation {

inline constexpr int stranger = -1, person = -2;  // senders that are no workers

struct Letter {
  int from = 0;
  std::string route;  // who it says it is: anybody can write anything there
  std::string bytes;
};

class CoordinatorProcess {
 public:
  explicit CoordinatorProcess(World& world) : world_(world) {}

  void start();
  void hear(Letter letter);
  void die(bool with_its_power);
  void stand_still(double seconds);  // SIGSTOP, a suspended machine
  bool alive() const { return reactor_ != nullptr; }
  bool settled() { return alive() && submitted_ && reactor_->settled(); }
  std::uint64_t epoch() const { return epoch_; }

 private:
  struct Outgoing {
    int to = 0;
    wire::RequestEnvelope asked;
    wire::ReplyEnvelope reply;
  };
  void open();
  void turn();
  void turn_soon(double after_s);
  std::optional<Outgoing> answer(const Letter& letter);
  Instant instant_for(int from) const;
  void send(std::vector<Outgoing> replies);
  void look();

  World& world_;
  std::optional<Ledger> ledger_;
  std::unique_ptr<Reactor> reactor_;
  std::deque<Letter> inbox_;
  std::uint64_t epoch_ = 0, life_ = 0, turns_asked_ = 0, fresh_id_ = 1u << 30;
  std::int64_t changes_ = -1;
  double still_until_ = 0.0;
  bool submitted_ = false, ever_opened_ = false;
};

}  // namespace fracfarm::simulation
