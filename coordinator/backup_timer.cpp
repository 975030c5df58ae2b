#include "coordinator/backup_timer.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "common/base/clock.hpp"
#include "coordinator/ledger_backup.hpp"

namespace fracfarm {

BackupTimer::BackupTimer(FarmPaths paths, double every_s) : paths_(std::move(paths)) {
  if (every_s > 0.0) thread_ = std::thread([this, every_s] { serve(every_s); });
}

BackupTimer::~BackupTimer() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    closing_ = true;
  }
  closing_now_.notify_one();
  thread_.join();
}

std::vector<std::string> BackupTimer::take_words() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(words_, {});
}

void BackupTimer::serve(double every_s) {
  const auto pause = std::chrono::duration<double>(every_s);
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (closing_now_.wait_for(lock, pause, [this] { return closing_; })) return;
    }
    const Result<std::filesystem::path> made = back_up_farm(paths_, SystemClock{}.wall_s());
    const std::scoped_lock lock(mutex_);
    words_.push_back(made ? fmt::format("the ledger was copied to {}", made->string())
                          : fmt::format("the ledger could not be copied: {}", made.error().message));
  }
}

}  // namespace fracfarm
