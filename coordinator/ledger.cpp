#include "coordinator/ledger.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <system_error>

#include "coordinator/ledger_schema.hpp"

namespace fracfarm {
namespace {

std::string random_id() {
  std::random_device source;
  return fmt::format("{:08x}{:08x}", source(), source());
}

Result<void> prepare(Database& database) {
  database.script(
      "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA trusted_schema = OFF; PRAGMA cache_size = "
      "-65536;"
      "PRAGMA temp_store = MEMORY; PRAGMA wal_autocheckpoint = 8000;");
  // Everything that the log holds goes to the database, written and synced anew: after a sync that failed the system may show pages that
  // never reached the disk, and whatever is committed behind them would be lost with them.
  database.script("PRAGMA wal_checkpoint(TRUNCATE)");
  if (Result<void> done = migrate(database); !done) return done;
  database.script("PRAGMA foreign_keys = ON");  // a migration rebuilds tables that others point at
  database.run("INSERT INTO meta VALUES('farm_id', ?1) ON CONFLICT DO NOTHING", random_id());
  return {};
}

}  // namespace

Result<Ledger> Ledger::open(const FarmPaths& paths, bool make, double patience_s, std::string_view holder) {
  std::error_code error;
  if (!make && !std::filesystem::exists(paths.ledger(), error))
    return fail(Fault::node_lost, fmt::format("there is no farm in {}: fracfarm submit or run makes one", paths.farm.string()));
  if (!std::filesystem::exists(paths.ledger_folder(), error)) std::filesystem::create_directories(paths.ledger_folder(), error);
  if (error) return fail(Fault::node_lost, fmt::format("cannot make {}: {}", paths.ledger_folder().string(), error.message()));
  if (Result<void> local = demand_local_disk(paths.ledger_folder()); !local) return tl::unexpected(local.error());
  Result<LedgerLock> lock = LedgerLock::take(paths.lock(), patience_s, holder);
  if (!lock) return tl::unexpected(lock.error());
  Database database = Database::open(paths.ledger());
  if (Result<void> ready = prepare(database); !ready) return tl::unexpected(ready.error());
  return Ledger(std::move(database), std::move(*lock));
}

Ledger Ledger::in_memory() {
  Database database = Database::open({});
  (void)prepare(database);
  return Ledger(std::move(database), std::nullopt);
}

Result<Ledger> Ledger::over(Database database) {
  if (Result<void> ready = prepare(database); !ready) return tl::unexpected(ready.error());
  return Ledger(std::move(database), std::nullopt);
}

void Ledger::set_meta(const std::string& name, const std::string& value) {
  database_.run("INSERT INTO meta VALUES(?1, ?2) ON CONFLICT DO UPDATE SET value = excluded.value", name, value);
}

std::uint64_t Ledger::raise_epoch() {
  begin();
  database_.run("INSERT INTO meta VALUES('epoch', '1') ON CONFLICT DO UPDATE SET value = CAST(CAST(value AS INTEGER) + 1 AS TEXT)");
  commit();
  Rows rows = database_.query("SELECT CAST(value AS INTEGER) FROM meta WHERE name = 'epoch'");
  rows.next();
  return static_cast<std::uint64_t>(rows.integer(0));
}

void Ledger::set_build_id(const std::string& build_id) { set_meta("build_id", build_id); }

std::int64_t Ledger::add_campaign(const std::string& name, const std::string& text, const std::string& build_id, std::uint64_t total,
                                  double wall_s) {
  database_.run("INSERT INTO campaigns(name, text, build_id, total, submitted_at) VALUES(?1, ?2, ?3, ?4, ?5) ON CONFLICT DO NOTHING", name,
                text, build_id, total, wall_s);
  Rows rows = database_.query("SELECT id FROM campaigns WHERE text = ?1 AND build_id = ?2", text, build_id);
  rows.next();
  return rows.integer(0);
}

void Ledger::advance_campaign(std::int64_t campaign, std::uint64_t expanded, std::uint64_t newly_shared) {
  database_.run("UPDATE campaigns SET expanded = ?2, shared = shared + ?3 WHERE id = ?1", campaign, expanded, newly_shared);
}

std::int64_t Ledger::register_worker(const std::string& peer, const wire::Hello& hello, double wall_s) {
  database_.run("UPDATE workers SET ended_at = ?3 WHERE peer = ?1 AND instance <> ?2 AND ended_at IS NULL", peer, hello.instance, wall_s);
  database_.run(
      "INSERT INTO workers(peer, instance, node, slots, memory_bytes, build_id, began_at, node_type) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)"
      " ON CONFLICT(peer, instance) DO UPDATE SET ended_at = NULL",
      peer, bounded(hello.instance), bounded(hello.node), hello.slots, static_cast<std::int64_t>(hello.memory_bytes),
      bounded(hello.build_id), wall_s, node_type_of(hello.slots, hello.memory_bytes));
  Rows rows = database_.query("SELECT id FROM workers WHERE peer = ?1 AND instance = ?2", peer, bounded(hello.instance));
  rows.next();
  return rows.integer(0);
}

void Ledger::end_worker(std::int64_t worker, double wall_s) {
  database_.run("UPDATE workers SET ended_at = ?2 WHERE id = ?1", worker, wall_s);
}
void Ledger::drain_worker(std::int64_t worker) { database_.run("UPDATE workers SET draining = 1 WHERE id = ?1", worker); }

void Ledger::lease(std::int64_t job, wire::LeaseId lease, std::int64_t worker, double wall_s) {
  database_.run(
      "UPDATE jobs SET state = 'LEASED', attempts = attempts + 1, lease_epoch = ?2, lease_counter = ?3, worker = ?4, leased_at = ?5, "
      "wait_s = NULL"
      " WHERE id = ?1 AND state = 'READY'",
      job, lease.epoch, lease.counter, worker, wall_s);
}

void Ledger::adopt(std::int64_t job, std::int64_t worker) {
  database_.run("UPDATE jobs SET worker = ?2 WHERE id = ?1 AND state = 'LEASED'", job, worker);
}

std::int64_t Ledger::numbered(std::map<std::string, std::int64_t>& known, const std::string& name, std::string_view insert,
                              std::string_view select) {
  if (const auto found = known.find(name); found != known.end()) return found->second;
  database_.run(insert, name);
  Rows rows = database_.query(select, name);
  rows.next();
  return known[name] = rows.integer(0);
}

std::int64_t Ledger::shard_id(const std::string& name) {
  return numbered(shards_, name, "INSERT INTO shards(name) VALUES(?1) ON CONFLICT DO NOTHING", "SELECT id FROM shards WHERE name = ?1");
}
std::int64_t Ledger::rule_id(const std::string& name) {
  return numbered(rules_, name, "INSERT INTO rules(name) VALUES(?1) ON CONFLICT DO NOTHING", "SELECT id FROM rules WHERE name = ?1");
}

void Ledger::complete(const Job& job, const Outcome& outcome, wire::LeaseId lease, std::int64_t worker) {
  const bool has_record = !outcome.shard.empty();
  const std::int64_t shard = has_record ? shard_id(outcome.shard) : 0;
  const std::string digest = bytes_of_hex(outcome.sha256);
  const auto kept_digest = has_record ? std::optional(Blob{digest}) : std::nullopt;
  database_.run(
      "UPDATE jobs SET state = 'DONE', wait_s = NULL, lease_epoch = ?2, lease_counter = ?3, worker = nullif(?4, 0), verdict = ?5, "
      "time_to_failure = ?6, rule = ?7, peak_stress = ?8, steps = ?9, cpu_s = ?10, wall_s = ?11, done_at = ?12, shard = nullif(?13, 0), "
      "offset = ?14, "
      "length = "
      "?15, sha256 = ?16"
      " WHERE id = ?1",
      job.id, lease.epoch, lease.counter, worker, name_of(outcome.verdict), outcome.time_to_failure, rule_id(bounded(outcome.failure_rule)),
      outcome.peak_stress, outcome.steps, outcome.cpu_s, outcome.wall_s, outcome.done_at, shard, outcome.offset, outcome.length,
      kept_digest);
  ++tally_.done[worker];
  if (has_record) learn(job, outcome, worker);
  if (!database_.in_transaction()) settle();
}

void Ledger::learn(const Job& job, const Outcome& outcome, std::int64_t worker) {
  Tally::Took& took = tally_.took[{class_id(job.job_class), worker, duration_bin(outcome.wall_s)}];
  ++took.n;
  took.wall_s += outcome.wall_s;
  took.bytes += outcome.length;
}

void Ledger::settle() {
  for (const auto& [worker, n] : tally_.done) database_.run("UPDATE workers SET done = done + ?2 WHERE id = ?1", worker, n);
  for (const auto& [of, took] : tally_.took)
    database_.run(
        "INSERT INTO durations VALUES(?1, coalesce((SELECT node_type FROM workers WHERE id = ?2), ''), ?3, ?4, ?5, ?6)"
        " ON CONFLICT DO UPDATE SET n = n + excluded.n, wall_s = wall_s + excluded.wall_s, bytes = bytes + excluded.bytes",
        std::get<0>(of), std::get<1>(of), std::get<2>(of), took.n, took.wall_s, took.bytes);
  tally_ = {};
}

void Ledger::record_attempt(const Job& job, const Attempt& attempt, double wall_s) {
  database_.run(
      "INSERT INTO attempts(job, attempt, worker, fault, signature, message, began_at, ended_at) VALUES(?1, ?2, nullif(?3, 0), ?4, ?5, ?6, "
      "?7, ?8)",
      job.id, job.attempts, job.worker, fault_row(attempt.fault).name, bounded(attempt.signature), bounded(attempt.message), job.leased_at,
      wall_s);
  if (attempt.fault != Fault::planned_stop) database_.run("UPDATE workers SET faults = faults + 1 WHERE id = ?1", job.worker);
}

void Ledger::make_ready(std::int64_t job) { database_.run("UPDATE jobs SET state = 'READY', wait_s = NULL WHERE id = ?1", job); }
void Ledger::make_wait(std::int64_t job, double wait_s, double step_scale, std::uint64_t memory_floor) {
  database_.run("UPDATE jobs SET state = 'RETRY_WAIT', wait_s = ?2, step_scale = ?3, memory_floor = ?4 WHERE id = ?1", job, wait_s,
                step_scale, memory_floor);
}
void Ledger::quarantine(std::int64_t job) { database_.run("UPDATE jobs SET state = 'QUARANTINED', wait_s = NULL WHERE id = ?1", job); }
void Ledger::cancel(std::int64_t job) {
  database_.run("UPDATE jobs SET state = 'CANCELLED', wait_s = NULL WHERE id = ?1 AND state <> 'DONE'", job);
}
void Ledger::hold(std::int64_t job) {
  database_.run("UPDATE jobs SET state = 'HELD', wait_s = NULL WHERE id = ?1 AND state IN ('READY', 'RETRY_WAIT')", job);
}
void Ledger::prioritize(std::int64_t job, int priority) { database_.run("UPDATE jobs SET priority = ?2 WHERE id = ?1", job, priority); }

void Ledger::forgive(std::int64_t job) {
  database_.run(
      "UPDATE jobs SET state = 'READY', wait_s = NULL, step_scale = 1, memory_floor = 0, forgiven = (SELECT coalesce(max(id), 0) FROM "
      "attempts WHERE job = "
      "?1) WHERE id = ?1",
      job);
}

std::string text_of(const JobClass& it) { return fmt::format("{} {} {}", it.method, it.material, it.load); }

std::string node_type_of(int slots, std::uint64_t memory_bytes) {
  return fmt::format("{} slots, {} GB", slots, (memory_bytes + (std::uint64_t{1} << 29)) >> 30);
}

// STRICT text columns take any bytes; what comes from outside is kept to a bounded length.
std::string bounded(const std::string& text) {
  constexpr std::size_t longest_text = 4000;
  return text.substr(0, longest_text);
}

std::string bytes_of_hex(std::string_view hex) {
  const auto digit = [](char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1; };
  std::string bytes;
  if (hex.size() % 2) return bytes;
  bytes.reserve(hex.size() / 2);
  for (std::size_t at = 0; at < hex.size(); at += 2) {
    const int high = digit(hex[at]), low = digit(hex[at + 1]);
    if (high < 0 || low < 0) return {};
    bytes.push_back(static_cast<char>(high * 16 + low));
  }
  return bytes;
}

std::string hex_of_bytes(std::string_view bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string hex;
  hex.reserve(bytes.size() * 2);
  for (const char c : bytes) {
    hex.push_back(digits[static_cast<unsigned char>(c) >> 4]);
    hex.push_back(digits[static_cast<unsigned char>(c) & 15]);
  }
  return hex;
}

int duration_bin(double seconds) { return static_cast<int>(std::floor(4.0 * std::log2(std::fmax(seconds, 1e-3)))); }
double duration_bin_top(int bin) { return std::exp2((bin + 1) / 4.0); }

}  // namespace fracfarm
