// A worker daemon as a process that may die at any moment: the real session; its link, slots, keeper and outbox are simulated, in the order
// in which the real ones act: record into the shard, sync, outbox, report.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/simulation/world.hpp"
#include "worker/session.hpp"

namespace fracfarm::simulation {

class WorkerProcess {
 public:
  WorkerProcess(World& world, int number);

  void start();
  void hear(const std::string& bytes);
  void die(bool with_its_node);
  void feed(const worker::Event& event);
  bool alive() const { return session_.has_value(); }
  void have_end(bool yes) { has_end_ = yes; }  // of its allocation, in this life and the next ones
  double own_clock_s() const { return 1000.0 + world_.agenda.now() + clock_offset_s_; }

 private:
  struct Stored {  // in a shard
    std::string bytes;
    bool synced = false;
    wire::Completion completion;
  };
  void act(const worker::Action& action);
  void post(const wire::Request& request);
  void resend_later();
  void tick();
  void later(double after_s, std::function<void()> what);  // unless it dies before
  void end_job(worker::JobId job, const wire::Assignment& assignment);
  void append(worker::JobId job, const wire::Assignment& assignment, double wall_s);
  void sync(worker::JobId job, std::size_t at);
  void note(worker::JobId job, std::size_t at);
  void fail(worker::JobId job, Fault fault, const std::string& signature);

  World& world_;
  int number_;
  double clock_offset_s_;
  std::optional<worker::Session> session_;
  std::uint64_t life_ = 0;
  bool has_end_ = false;
  std::map<worker::JobId, wire::Assignment> running_;
  // link
  std::uint64_t request_id_ = 0, epoch_seen_ = 0;
  std::string pending_;
  double silence_s_ = 2.0;
  // disk
  std::vector<wire::Completion> outbox_;
  std::vector<Stored> shard_;
};

}  // namespace fracfarm::simulation
