// The ledger: the farm's only memory. Everything here writes; queries.hpp reads. Callers open a transaction, write, commit, and only then
// tell anybody. Every SQLite failure is a LedgerError (ledger_sqlite.hpp): it ends the program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "common/wire/messages.hpp"
#include "coordinator/job.hpp"
#include "coordinator/ledger_folder.hpp"
#include "coordinator/ledger_sqlite.hpp"

namespace fracfarm {

// How a try ended that gave no result.
struct Attempt {
  Fault fault = Fault::node_lost;
  std::string signature;
  std::string message;
};

class Ledger {
 public:
  // Takes the lock, opens (or, with `make`, makes) FARM/ledger/ledger.db, migrates. Errors: NODE_LOST where it is held by another or there
  // is none, BAD_REQUEST on a network file system or a later schema.
  static Result<Ledger> open(const FarmPaths& paths, bool make, double patience_s = 2.0, std::string_view holder = holder_command);
  static Ledger in_memory();

  void begin() { database_.begin(); }
  void commit() { database_.commit(); }
  void rollback() { database_.rollback(); }
  Database& reading() { return database_; }

  std::uint64_t raise_epoch();  // and gives it; its own transaction, on the disk when this returns
  void set_build_id(const std::string& build_id);

  // The campaign's row; the earlier one where the same text was submitted for the same build.
  std::int64_t add_campaign(const std::string& name, const std::string& text, const std::string& build_id, std::uint64_t total,
                            double wall_s);
  void advance_campaign(std::int64_t campaign, std::uint64_t expanded, std::uint64_t newly_shared);
  bool add_job(const NewJob& job);  // READY; false: a job of this key is there already

  std::int64_t register_worker(const std::string& peer, const wire::Hello& hello, double wall_s);
  void end_worker(std::int64_t worker, double wall_s);
  void drain_worker(std::int64_t worker);

  void lease(std::int64_t job, wire::LeaseId lease, std::int64_t worker, double wall_s);  // READY -> LEASED
  void adopt(std::int64_t job, std::int64_t worker);                                      // LEASED, by a new instance of its holder
  void complete(const Job& job, const Outcome& outcome, wire::LeaseId lease, std::int64_t worker);  // -> DONE
  void record_attempt(const Job& job, const Attempt& attempt, double wall_s);
  void make_ready(std::int64_t job);
  void make_wait(std::int64_t job, double wait_s, double step_scale);  // RETRY_WAIT
  void quarantine(std::int64_t job);
  void cancel(std::int64_t job);
  void forgive(std::int64_t job);  // READY, with every budget anew and the whole time step
  void raise_nondeterminism(std::int64_t job, const std::string& message, double wall_s);

 private:
  Ledger(Database database, std::optional<LedgerLock> lock) : lock_(std::move(lock)), database_(std::move(database)) {}
  std::int64_t shard_id(const std::string& name);
  void learn(const Job& job, const Outcome& outcome);
  void set_meta(const std::string& name, const std::string& value);

  std::optional<LedgerLock> lock_;  // outlives the database
  Database database_;
};

std::string bytes_of_hex(std::string_view hex);  // empty where it is not hex of an even length
std::string hex_of_bytes(std::string_view bytes);
int duration_bin(double seconds);
double duration_bin_top(int bin);  // s

}  // namespace fracfarm
