// Completions that are durable in a shard and not yet known to be acknowledged: one small file in the worker's own folder, replaced as a
// whole. What is acknowledged is dropped from memory and leaves the file with its next replacement: an entry too many is answered
// DUPLICATE.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/wire/messages.hpp"

namespace fracfarm::worker {

class Outbox {
 public:
  // Reads what an earlier run left. A damaged file is set aside (its jobs are solved again) and said in `warning`.
  static Outbox open(const std::filesystem::path& file, std::string& warning);

  const std::vector<wire::Completion>& completions() const { return completions_; }
  // Durable when it returns. Errors: NODE_LOST; then nothing was added.
  Result<void> add(const std::vector<wire::Completion>& completions);
  void acknowledge(const std::vector<std::string>& keys);
  Result<void> close();  // writes what is left, or removes the file where nothing is

 private:
  explicit Outbox(std::filesystem::path file) : file_(std::move(file)) {}
  Result<void> write() const;

  std::filesystem::path file_;
  std::vector<wire::Completion> completions_;
};

}  // namespace fracfarm::worker
