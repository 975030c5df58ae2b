#include "coordinator/ledger_backup.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "common/base/clock.hpp"
#include "coordinator/ledger_schema.hpp"

namespace fracfarm {
namespace {

namespace fs = std::filesystem;

struct Close {
  void operator()(sqlite3* handle) const { sqlite3_close(handle); }
};
using Handle = std::unique_ptr<sqlite3, Close>;

Result<Handle> open_file(const fs::path& file, int flags) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &raw, flags | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
  Handle handle(raw);
  if (code != SQLITE_OK) return fail(Fault::node_lost, fmt::format("cannot open {}: {}", file.string(), sqlite3_errstr(code)));
  sqlite3_busy_timeout(raw, 5000);
  return handle;
}

// The first cell of the first row, or empty.
std::string one_text(sqlite3* handle, const char* sql) {
  std::string text;
  sqlite3_exec(
      handle, sql,
      [](void* out, int columns, char** values, char**) {
        if (columns > 0 && values[0]) *static_cast<std::string*>(out) = values[0];
        return 1;
      },
      &text, nullptr);
  return text;
}

Result<void> sync(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  if (descriptor >= 0) ::close(descriptor);
  if (!synced) return fail(Fault::node_lost, fmt::format("cannot sync {}", path.string()));
  return {};
}

Result<void> copy_pages(const fs::path& from, const fs::path& to) {
  const Result<Handle> source = open_file(from, SQLITE_OPEN_READWRITE);  // a reader of a WAL ledger must be able to write its index
  if (!source) return tl::unexpected(source.error());
  const Result<Handle> target = open_file(to, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  if (!target) return tl::unexpected(target.error());
  sqlite3_backup* backup = sqlite3_backup_init(target->get(), "main", source->get(), "main");
  const int stepped = backup ? sqlite3_backup_step(backup, -1) : SQLITE_ERROR;  // one read transaction: one moment
  const int ended = backup ? sqlite3_backup_finish(backup) : SQLITE_ERROR;
  if (stepped != SQLITE_DONE || ended != SQLITE_OK)
    return fail(Fault::node_lost, fmt::format("cannot copy {} to {}: {}", from.string(), to.string(), sqlite3_errmsg(target->get())));
  if (sqlite3_exec(target->get(), "PRAGMA journal_mode = DELETE", nullptr, nullptr, nullptr) != SQLITE_OK)
    return fail(Fault::node_lost, fmt::format("cannot close {}: {}", to.string(), sqlite3_errmsg(target->get())));
  return {};
}

Result<void> check_copy_and_name(const fs::path& raw, const fs::path& name) {
  if (Result<void> done = sync(raw); !done) return done;
  if (Result<void> sound = check_ledger_file(raw); !sound) return sound;
  std::error_code error;
  fs::rename(raw, name, error);
  if (error) return fail(Fault::node_lost, fmt::format("cannot name {}: {}", name.string(), error.message()));
  return sync(name.parent_path().empty() ? fs::path(".") : name.parent_path());
}

}  // namespace

Result<void> check_ledger_file(const fs::path& file) {
  const Result<Handle> handle = open_file(file, SQLITE_OPEN_READONLY);
  if (!handle) return tl::unexpected(handle.error());
  if (const std::string said = one_text(handle->get(), "PRAGMA integrity_check(1)"); said != "ok")
    return fail(Fault::output_bad, fmt::format("{} is not a sound ledger: {}", file.string(), said.empty() ? "no database" : said));
  if (one_text(handle->get(), "SELECT count(*) FROM sqlite_schema WHERE name IN ('jobs', 'campaigns', 'meta')") != "3")
    return fail(Fault::bad_request, fmt::format("{} is no ledger of a farm", file.string()));
  const std::string version = one_text(handle->get(), "PRAGMA user_version");
  if (std::stoll(version) > static_cast<long long>(migrations().size()))
    return fail(Fault::bad_request,
                fmt::format("{} is of schema {}, this program knows up to {}", file.string(), version, migrations().size()));
  return {};
}

Result<void> back_up_ledger(const fs::path& ledger, const fs::path& copy) {
  std::error_code error;
  if (!fs::exists(ledger, error)) return fail(Fault::node_lost, fmt::format("there is no ledger {}", ledger.string()));
  fs::path raw = copy;
  raw += ".part";
  fs::remove(raw, error);
  Result<void> done = copy_pages(ledger, raw);
  if (done) done = check_copy_and_name(raw, copy);
  if (!done) fs::remove(raw, error);
  return done;
}

Result<void> put_back_ledger(const FarmPaths& paths, const fs::path& copy) {
  if (Result<void> sound = check_ledger_file(copy); !sound) return sound;
  std::error_code error;
  fs::create_directories(paths.ledger_folder(), error);
  if (Result<void> local = demand_local_disk(paths.ledger_folder()); !local) return local;
  const Result<LedgerLock> lock = LedgerLock::take(paths.lock(), 2.0, holder_command);
  if (!lock) return tl::unexpected(lock.error());
  fs::path raw = paths.ledger();
  raw += ".part";
  fs::copy_file(copy, raw, fs::copy_options::overwrite_existing, error);
  if (error) return fail(Fault::node_lost, fmt::format("cannot copy {}: {}", copy.string(), error.message()));
  for (const char* suffix : {"", "-wal", "-shm"}) {  // the three belong together
    fs::path old = paths.ledger(), kept = paths.ledger();
    old += suffix;
    kept += fmt::format(".before-restore{}", suffix);
    if (fs::exists(old, error))
      fs::rename(old, kept, error);
    else
      fs::remove(kept, error);
  }
  return check_copy_and_name(raw, paths.ledger());
}

Result<fs::path> back_up_farm(const FarmPaths& paths, double wall_s, std::size_t keep) {
  const fs::path folder = paths.farm / "backups";
  std::error_code error;
  fs::create_directories(folder, error);
  std::string stamp = utc_text(wall_s);
  std::erase_if(stamp, [](char c) { return c == '-' || c == ':'; });
  const fs::path name = folder / fmt::format("ledger-{}.db", stamp);
  if (Result<void> done = back_up_ledger(paths.ledger(), name); !done) return tl::unexpected(done.error());
  std::vector<fs::path> all;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().filename().string().starts_with("ledger-") && it->path().extension() == ".db") all.push_back(it->path());
  std::sort(all.begin(), all.end());
  for (std::size_t at = 0; at + keep < all.size(); ++at) fs::remove(all[at], error);
  return name;
}

}  // namespace fracfarm
