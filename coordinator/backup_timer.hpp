// Copies a farm's ledger every so often, in a thread and a database connection of its own: the coordinator goes on meanwhile.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/ledger_folder.hpp"

namespace fracfarm {

class BackupTimer {
 public:
  BackupTimer(FarmPaths paths, double every_s);  // every_s <= 0: never
  ~BackupTimer();
  std::vector<std::string> take_words();  // for the log: what was copied, or why not

 private:
  void serve(double every_s);
  FarmPaths paths_;
  std::mutex mutex_;
  std::condition_variable closing_now_;
  bool closing_ = false;
  std::vector<std::string> words_;
  std::thread thread_;
};

}  // namespace fracfarm
