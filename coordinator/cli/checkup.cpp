#include "coordinator/cli/checkup.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/timex.h>

#include <algorithm>
#include <chrono>

#include "common/base/atomic_file.hpp"
#include "common/base/text.hpp"
#include "coordinator/ledger_folder.hpp"

namespace fracfarm::cli {
namespace {

namespace fs = std::filesystem;
using Verdict = CheckupLine::Verdict;

constexpr double least_bytes = 2e9, low_bytes = 20e9;  // a shard of a thousand records is about 1 GB
constexpr double least_inodes = 1000.0;
constexpr double usual_files = 1024.0;  // sockets of workers, databases, logs
constexpr double most_clock_error_s = 1.0;
constexpr double slow_sync_s = 0.05;

// The nearest folder above that is there.
fs::path existing(fs::path path) {
  std::error_code none;
  path = fs::absolute(path, none);
  while (!fs::exists(path, none) && path.has_parent_path() && path != path.parent_path()) path = path.parent_path();
  return path;
}

CheckupLine ledger_place(const FarmPaths& paths) {
  const fs::path folder = existing(paths.ledger_folder());
  const Result<void> local = demand_local_disk(folder);
  if (local) return {Verdict::good, "ledger's file system", fmt::format("{} is on a local disk", folder.string()), ""};
  return {Verdict::bad, "ledger's file system", local.error().message, "only the machine that runs the coordinator needs this"};
}

CheckupLine disk(const std::string& name, const fs::path& path) {
  struct statvfs facts {};
  const fs::path folder = existing(path);
  if (::statvfs(folder.c_str(), &facts) != 0)
    return {Verdict::bad, name, fmt::format("cannot look at {}", folder.string()), "is it mounted?"};
  const double inodes = static_cast<double>(facts.f_files);
  return judge_disk(name, static_cast<double>(facts.f_bavail) * static_cast<double>(facts.f_frsize), static_cast<double>(facts.f_favail),
                    inodes);
}

CheckupLine sync_time(const fs::path& path) {
  const fs::path file = existing(path) / ".fracfarm-doctor";
  const auto before = std::chrono::steady_clock::now();
  const Result<void> wrote = write_atomically(file, "x");
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  std::error_code none;
  fs::remove(file, none);
  if (!wrote) return {Verdict::bad, "writing", wrote.error().message, "the farm's folder must be writable"};
  const std::string found = fmt::format("a synced write takes {:.1f} ms", 1e3 * took_s);
  if (took_s < slow_sync_s) return {Verdict::good, "writing", found, ""};
  return {Verdict::warning, "writing", found, "results are committed in groups, but a disk that syncs faster serves more workers"};
}

CheckupLine clock_state() {
  timex facts{};
  const int state = ::adjtimex(&facts);
  return judge_clock(state >= 0 && (facts.status & STA_UNSYNC) == 0, static_cast<double>(facts.esterror) * 1e-6);
}

std::vector<CheckupLine> keys(const fs::path& farm) {
  std::vector<CheckupLine> lines;
  std::error_code error;
  for (fs::directory_iterator it(farm / "keys", error), end; !error && it != end; it.increment(error)) {
    struct stat facts {};
    if (it->path().extension() == ".pub" || it->is_directory() || ::stat(it->path().c_str(), &facts) != 0) continue;
    CheckupLine line = judge_key(it->path(), facts.st_mode & 07777u);
    if (line.verdict != Verdict::good) lines.push_back(std::move(line));
  }
  if (lines.empty())
    lines.push_back({Verdict::good, "keys", error ? "none yet: they are made on first use" : "only their owner can read them", ""});
  return lines;
}

CheckupLine file_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  return judge_file_limit(limit.rlim_max == RLIM_INFINITY ? 1e18 : static_cast<double>(limit.rlim_max));  // a coordinator raises its own
}

}  // namespace

std::string_view word_of(Verdict verdict) {
  constexpr std::string_view words[] = {"good", "warning", "bad"};
  return words[static_cast<int>(verdict)];
}

CheckupLine judge_disk(const std::string& name, double free_bytes, double free_inodes, double inodes) {
  const std::string found = fmt::format("{} and {} free", bytes_text(static_cast<std::uint64_t>(free_bytes)),
                                        inodes > 0.0 ? fmt::format("{:.0f} inodes", free_inodes) : "any number of inodes");
  const bool no_inodes = inodes > 0.0 && free_inodes < least_inodes;
  if (free_bytes < least_bytes || no_inodes)
    return {Verdict::bad, name, found, "make room: a worker that finds the disk full gives its jobs back"};
  if (free_bytes < low_bytes) return {Verdict::warning, name, found, "fracfarm plan says what a campaign needs"};
  return {Verdict::good, name, found, ""};
}

CheckupLine judge_file_limit(double most_files) {
  const std::string found = fmt::format("{:.0f} open files allowed", most_files);
  if (most_files >= usual_files) return {Verdict::good, "limits", found, ""};
  return {Verdict::warning, "limits", found,
          fmt::format("ulimit -Hn {:.0f}: a coordinator has a connection for every worker", usual_files)};
}

CheckupLine judge_clock(bool synchronized, double error_s) {
  if (synchronized && error_s < most_clock_error_s)
    return {Verdict::good, "clock", fmt::format("synchronized, within {:.0f} ms", 1e3 * error_s), ""};
  return {Verdict::warning, "clock", synchronized ? fmt::format("may be off by {:.1f} s", error_s) : "not synchronized",
          "run chrony or ntpd: no result depends on it, but the times in logs and status do"};
}

CheckupLine judge_key(const fs::path& file, unsigned mode) {
  if ((mode & 077u) == 0) return {Verdict::good, "keys", fmt::format("{} is its owner's alone", file.filename().string()), ""};
  return {Verdict::bad, "keys", fmt::format("{} has mode {:o}: others can read it", file.string(), mode),
          fmt::format("chmod 600 {}, and make new keys where it may have been read", file.string())};
}

std::vector<CheckupLine> check_up(const fs::path& farm) {
  const FarmPaths paths{farm};
  std::vector<CheckupLine> lines{ledger_place(paths),
                                 disk("ledger's disk", paths.ledger_folder()),
                                 disk("store's disk", farm / "store"),
                                 sync_time(farm),
                                 clock_state(),
                                 file_limit()};
  for (CheckupLine& line : keys(farm)) lines.push_back(std::move(line));
  return lines;
}

}  // namespace fracfarm::cli
