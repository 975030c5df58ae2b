// The ledger: the farm's only memory. Everything here writes; queries.hpp reads. Callers open a transaction, write, commit, and only then
// tell anybody. Every SQLite failure is a LedgerError (ledger_sqlite.hpp): it ends the program.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>

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
  static Result<Ledger> over(Database database);  // migrated; the caller sees to it that nobody else holds it

  void begin() { database_.begin(); }
  void commit() {
    settle();
    database_.commit();
  }
  void rollback() {
    database_.rollback();
    classes_.clear(), rules_.clear(), shards_.clear();
    tally_ = {};
  }
  // Writes what results have added up to since the last commit: to be called before these sums are read in the same transaction.
  void settle();
  Database& reading() { return database_; }

  std::uint64_t raise_epoch();  // and gives it; its own transaction, on the disk when this returns
  void set_build_id(const std::string& build_id);
  void set_meta(const std::string& name, const std::string& value);

  // The campaign's row; the earlier one where the same text was submitted for the same build.
  std::int64_t add_campaign(const std::string& name, const std::string& text, const std::string& build_id, std::uint64_t total,
                            double wall_s);
  void advance_campaign(std::int64_t campaign, std::uint64_t expanded, std::uint64_t newly_shared);
  std::int64_t place_campaign(std::int64_t campaign);  // gives its jobs their ids: that of position 0
  void add_series(const std::string& identity, const SeriesPlace& place);
  void add_lane(const Lane& lane);
  // The lane without its jobs before `next`; it ends where none is left.
  void advance_lane(const Lane& lane, std::int64_t next);
  void take_from_lane(const Lane& lane, std::int64_t job);      // any one of its jobs
  Lane split_lane(const Lane& lane, std::uint64_t n);           // gives its first n jobs, as a lane
  void set_lane(std::int64_t lane, State state, int priority);  // HELD, READY or CANCELLED
  bool add_job(const NewJob& job);                              // false: a job of this key is there already
  // LEASED from the start; false as above.
  bool add_leased(const NewJob& job, wire::LeaseId lease, std::int64_t worker, double wall_s);
  void count_shared(std::int64_t campaign);  // one of its jobs turned out to be there already

  std::int64_t register_worker(const std::string& peer, const wire::Hello& hello, double wall_s);
  void end_worker(std::int64_t worker, double wall_s);
  void drain_worker(std::int64_t worker);

  void lease(std::int64_t job, wire::LeaseId lease, std::int64_t worker, double wall_s);  // READY -> LEASED
  void adopt(std::int64_t job, std::int64_t worker);                                      // LEASED, by a new instance of its holder
  void complete(const Job& job, const Outcome& outcome, wire::LeaseId lease, std::int64_t worker);  // -> DONE
  void record_attempt(const Job& job, const Attempt& attempt, double wall_s);
  void make_ready(std::int64_t job);
  void make_wait(std::int64_t job, double wait_s, double step_scale, std::uint64_t memory_floor);  // RETRY_WAIT
  void quarantine(std::int64_t job);
  void cancel(std::int64_t job);
  void hold(std::int64_t job);  // HELD, of those that wait
  void prioritize(std::int64_t job, int priority);
  void forgive(std::int64_t job);  // READY, with every budget anew and the whole time step
  void raise_alarm(std::string_view kind, std::int64_t job, const std::string& message, double wall_s);  // job 0: none
  void raise_nondeterminism(std::int64_t job, const std::string& message, double wall_s) {
    raise_alarm("NONDETERMINISM", job, message, wall_s);
  }
  void move_record(std::int64_t job, const Outcome& place);  // of a DONE job: its bytes lie elsewhere now

  void pause_class(const JobClass& job_class, const std::string& why, double wall_s);
  void resume_class(const JobClass& job_class);

  // What is held against a node.
  void blame(const std::string& node);
  void count_done(const std::string& node);
  void suspect(const std::string& node, const std::string& why);
  void trust(const std::string& node);

  // A DONE job to be computed again.
  std::int64_t add_recheck(std::int64_t job, std::string_view kind, const std::string& node, double wall_s);
  void lease_recheck(std::int64_t recheck, wire::LeaseId lease, std::int64_t worker);
  void end_recheck(std::int64_t recheck, std::string_view state, const std::string& message, double wall_s);
  void reopen_recheck(std::int64_t recheck, bool counted, const std::string& message);

 private:
  Ledger(Database database, std::optional<LedgerLock> lock) : lock_(std::move(lock)), database_(std::move(database)) {}
  std::int64_t class_id(const JobClass& job_class);
  std::int64_t rule_id(const std::string& name);
  std::int64_t shard_id(const std::string& name);
  std::int64_t numbered(std::map<std::string, std::int64_t>& known, const std::string& name, std::string_view insert,
                        std::string_view select);
  void learn(const Job& job, const Outcome& outcome, std::int64_t worker);

  // Sums that many results of one transaction add to, written once.
  struct Tally {
    struct Took {
      std::uint64_t n = 0;
      double wall_s = 0.0;
      std::uint64_t bytes = 0;
    };
    std::map<std::int64_t, std::uint64_t> done;                        // by worker
    std::map<std::tuple<std::int64_t, std::int64_t, int>, Took> took;  // by class, worker and bin of the duration
  };

  std::optional<LedgerLock> lock_;  // outlives the database
  Database database_;
  // Rows that never change, by what they are asked for; emptied by a rollback.
  std::map<JobClass, std::int64_t> classes_;
  std::map<std::string, std::int64_t> rules_, shards_;
  Tally tally_;
};

std::string node_type_of(int slots, std::uint64_t memory_bytes);  // "16 slots, 64 GB": what run times are learned by, beside the class
std::string bounded(const std::string& text);                     // text from outside, cut to what the ledger keeps
std::string bytes_of_hex(std::string_view hex);                   // empty where it is not hex of an even length
std::string hex_of_bytes(std::string_view bytes);
int duration_bin(double seconds);
double duration_bin_top(int bin);  // s

}  // namespace fracfarm
