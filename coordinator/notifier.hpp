// Tells somebody: runs a person's command for each notice, with the notice as JSON on its standard input. In a thread of its own and one at
// a time: a command that hangs is killed, one that fails is logged, and the coordinator waits for neither.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/reactor.hpp"

namespace fracfarm {

class Notifier {
 public:
  explicit Notifier(std::string command, double patience_s = 30.0);  // of /bin/sh; empty: nobody is told
  ~Notifier();                                                       // what waits is told first, for patience_s at most
  void tell(const std::vector<Notice>& notices, double wall_s);
  std::vector<std::string> take_complaints();  // for the log

 private:
  void serve();
  void run(const std::string& text);

  std::string command_;
  double patience_s_;
  std::mutex mutex_;
  std::condition_variable more_;
  std::deque<std::string> waiting_;
  std::vector<std::string> complaints_;
  bool closing_ = false;
  std::thread thread_;
};

std::string notice_json(const Notice& notice, double wall_s);  // fracfarm.notice/1

}  // namespace fracfarm
