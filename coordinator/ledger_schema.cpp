#include "coordinator/ledger_schema.hpp"

#include <fmt/format.h>

#include <array>

#include "coordinator/ledger_schema_1.hpp"

namespace fracfarm {
namespace {

// Jobs come to be when they are first touched: a campaign is a few lanes, each the untouched jobs of one class at every stride-th id.
// Classes and failure rules are numbers; what is needed to judge nodes, to recheck results and to pause classes is kept.
constexpr std::string_view version_2 = R"sql(
CREATE TABLE classes(
  id INTEGER PRIMARY KEY,
  method TEXT NOT NULL,
  material TEXT NOT NULL,
  load TEXT NOT NULL,
  paused TEXT,                        -- why none of it is handed out; null: it is
  paused_at REAL,
  UNIQUE(method, material, load)
) STRICT;
INSERT INTO classes(method, material, load) SELECT method, material, load FROM jobs UNION SELECT method, material, load FROM durations
  ORDER BY 1, 2, 3;

CREATE TABLE rules(                   -- of failure, as records name them
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
) STRICT;
INSERT INTO rules(name) SELECT DISTINCT failure_rule FROM jobs WHERE failure_rule IS NOT NULL ORDER BY 1;

ALTER TABLE campaigns ADD COLUMN first_id INTEGER NOT NULL DEFAULT 0;    -- of position 0; 0: its jobs were made one by one
ALTER TABLE workers ADD COLUMN node_type TEXT NOT NULL DEFAULT '';

CREATE TABLE series(                  -- which patterns of which settings a campaign has: equal identities are equal jobs
  identity BLOB NOT NULL CHECK(length(identity) = 16),
  campaign INTEGER NOT NULL REFERENCES campaigns(id),
  block INTEGER NOT NULL,
  variant INTEGER NOT NULL,           -- of its combinations of material, load and settings
  PRIMARY KEY(identity, campaign, block)
) STRICT, WITHOUT ROWID;

CREATE TABLE lanes(                   -- jobs that nobody has touched yet: ids next, next + stride, ..., last
  id INTEGER PRIMARY KEY,
  campaign INTEGER NOT NULL REFERENCES campaigns(id),
  class INTEGER NOT NULL REFERENCES classes(id),
  state TEXT NOT NULL CHECK(state IN ('READY', 'HELD', 'CANCELLED')),
  priority INTEGER NOT NULL DEFAULT 0,
  next INTEGER NOT NULL,
  last INTEGER NOT NULL,
  stride INTEGER NOT NULL CHECK(stride > 0),
  CHECK(next <= last AND (last - next) % stride = 0)
) STRICT;
CREATE INDEX lanes_ready ON lanes(priority DESC, next) WHERE state = 'READY';
CREATE INDEX lanes_campaign ON lanes(campaign);

CREATE TABLE jobs_2(
  id INTEGER PRIMARY KEY,
  key BLOB NOT NULL CHECK(length(key) = 32),
  campaign INTEGER NOT NULL REFERENCES campaigns(id),
  position INTEGER NOT NULL,
  class INTEGER NOT NULL REFERENCES classes(id),
  oblique INTEGER NOT NULL CHECK(oblique IN (0, 1)),  -- of which crack set
  sample_id INTEGER NOT NULL,
  state TEXT NOT NULL CHECK(state IN ('HELD','READY','LEASED','DONE','RETRY_WAIT','QUARANTINED','CANCELLED')),
  priority INTEGER NOT NULL DEFAULT 0,
  attempts INTEGER NOT NULL DEFAULT 0,
  forgiven INTEGER NOT NULL DEFAULT 0,
  step_scale REAL NOT NULL DEFAULT 1,
  memory_floor INTEGER NOT NULL DEFAULT 0,            -- bytes a slot must have more than
  wait_s REAL,
  lease_epoch INTEGER,
  lease_counter INTEGER,
  worker INTEGER REFERENCES workers(id),
  leased_at REAL,
  verdict TEXT CHECK(verdict IN ('failed','censored','rejected')),
  time_to_failure REAL,
  rule INTEGER REFERENCES rules(id),
  peak_stress REAL,
  steps INTEGER,
  cpu_s REAL,
  wall_s REAL,
  done_at REAL,
  shard INTEGER REFERENCES shards(id),
  offset INTEGER,
  length INTEGER,
  sha256 BLOB CHECK(length(sha256) = 32),
  CHECK((state = 'DONE') = (verdict IS NOT NULL)),
  CHECK(state <> 'LEASED' OR (lease_epoch IS NOT NULL AND worker IS NOT NULL)),
  CHECK(verdict IS NULL OR verdict = 'rejected' OR (shard IS NOT NULL AND sha256 IS NOT NULL)),
  CHECK(verdict IS NULL OR (verdict = 'failed') = (time_to_failure IS NOT NULL))
) STRICT;
INSERT INTO jobs_2 SELECT jobs.id, key, campaign, position, classes.id, crack_set = 'oblique', sample_id, state, priority, attempts, forgiven,
  step_scale, 0, wait_s, lease_epoch, lease_counter, worker, leased_at, verdict, time_to_failure, rules.id, peak_stress, steps, cpu_s, wall_s,
  done_at, shard, offset, length, sha256
  FROM jobs JOIN classes USING(method, material, load) LEFT JOIN rules ON rules.name = failure_rule;
DROP TABLE jobs;
ALTER TABLE jobs_2 RENAME TO jobs;
CREATE UNIQUE INDEX jobs_key ON jobs(substr(key, 1, 16));  -- half a SHA-256 is as unique, in half the space
CREATE INDEX jobs_ready ON jobs(priority DESC, id) WHERE state = 'READY';
CREATE INDEX jobs_retry ON jobs(id) WHERE state = 'RETRY_WAIT';
CREATE INDEX jobs_leased ON jobs(lease_epoch, lease_counter) WHERE state = 'LEASED';
CREATE INDEX jobs_set_aside ON jobs(state, id) WHERE state IN ('HELD', 'QUARANTINED', 'CANCELLED');

CREATE TABLE durations_2(             -- learned: wall seconds of results, in quarter octaves
  class INTEGER NOT NULL REFERENCES classes(id),
  node_type TEXT NOT NULL,            -- '': not known
  bin INTEGER NOT NULL,               -- floor(4 log2(seconds))
  n INTEGER NOT NULL,
  wall_s REAL NOT NULL,
  bytes INTEGER NOT NULL,
  PRIMARY KEY(class, node_type, bin)
) STRICT, WITHOUT ROWID;
INSERT INTO durations_2 SELECT classes.id, '', bin, n, wall_s, bytes FROM durations JOIN classes USING(method, material, load);
DROP TABLE durations;
ALTER TABLE durations_2 RENAME TO durations;

CREATE TABLE alarms_2(
  id INTEGER PRIMARY KEY,
  kind TEXT NOT NULL CHECK(kind IN ('NONDETERMINISM', 'CANARY', 'FUSE')),
  job INTEGER REFERENCES jobs(id),
  message TEXT NOT NULL,
  raised_at REAL NOT NULL
) STRICT;
INSERT INTO alarms_2 SELECT * FROM alarms;
DROP TABLE alarms;
ALTER TABLE alarms_2 RENAME TO alarms;

CREATE TABLE nodes(                   -- what is held against a node
  node TEXT PRIMARY KEY,
  blamed INTEGER NOT NULL DEFAULT 0,  -- failures of jobs that others then did
  done_since INTEGER NOT NULL DEFAULT 0,  -- results since the last of them
  suspect TEXT                        -- why it gets a canary before work; null: it is trusted
) STRICT, WITHOUT ROWID;

CREATE TABLE rechecks(                -- DONE jobs to be computed again: the result is compared, never counted again
  id INTEGER PRIMARY KEY,
  job INTEGER NOT NULL REFERENCES jobs(id),
  kind TEXT NOT NULL CHECK(kind IN ('CANARY', 'AUDIT', 'REPAIR')),
  state TEXT NOT NULL CHECK(state IN ('READY', 'LEASED', 'PASSED', 'DIFFERED', 'FAILED')),
  node TEXT NOT NULL,                 -- CANARY: only this one; else: not this one, where there is another
  tries INTEGER NOT NULL DEFAULT 0,
  worker INTEGER REFERENCES workers(id),
  lease_epoch INTEGER,
  lease_counter INTEGER,
  message TEXT NOT NULL DEFAULT '',
  made_at REAL NOT NULL,
  ended_at REAL
) STRICT;
CREATE INDEX rechecks_open ON rechecks(state, kind, id) WHERE state IN ('READY', 'LEASED');
CREATE INDEX rechecks_job ON rechecks(job);

DROP TABLE counts;
CREATE TABLE counts(
  campaign INTEGER NOT NULL,
  state TEXT NOT NULL,
  verdict TEXT NOT NULL,              -- '' unless DONE
  class INTEGER NOT NULL,
  n INTEGER NOT NULL CHECK(n >= 0),
  PRIMARY KEY(campaign, class, state, verdict)
) STRICT, WITHOUT ROWID;
INSERT INTO counts SELECT campaign, state, coalesce(verdict, ''), class, count(*) FROM jobs GROUP BY 1, 2, 3, 4;
CREATE TRIGGER count_new AFTER INSERT ON jobs BEGIN
  INSERT INTO counts VALUES(new.campaign, new.state, coalesce(new.verdict, ''), new.class, 1) ON CONFLICT DO UPDATE SET n = n + 1;
END;
CREATE TRIGGER count_move AFTER UPDATE OF state, verdict ON jobs WHEN old.state IS NOT new.state OR old.verdict IS NOT new.verdict BEGIN
  UPDATE counts SET n = n - 1 WHERE campaign = old.campaign AND class = old.class AND state = old.state AND verdict = coalesce(old.verdict, '');
  INSERT INTO counts VALUES(new.campaign, new.state, coalesce(new.verdict, ''), new.class, 1) ON CONFLICT DO UPDATE SET n = n + 1;
END;
CREATE TRIGGER count_lane AFTER INSERT ON lanes BEGIN
  INSERT INTO counts VALUES(new.campaign, new.state, '', new.class, (new.last - new.next) / new.stride + 1)
    ON CONFLICT DO UPDATE SET n = n + excluded.n;
END;
CREATE TRIGGER uncount_lane AFTER DELETE ON lanes BEGIN
  UPDATE counts SET n = n - ((old.last - old.next) / old.stride + 1)
    WHERE campaign = old.campaign AND class = old.class AND state = old.state AND verdict = '';
END;
CREATE TRIGGER recount_lane AFTER UPDATE OF next, last, state ON lanes BEGIN
  UPDATE counts SET n = n - ((old.last - old.next) / old.stride + 1)
    WHERE campaign = old.campaign AND class = old.class AND state = old.state AND verdict = '';
  INSERT INTO counts VALUES(new.campaign, new.state, '', new.class, (new.last - new.next) / new.stride + 1)
    ON CONFLICT DO UPDATE SET n = n + excluded.n;
END;

CREATE TABLE fault_tally(             -- how tries of each class of jobs ended badly
  class INTEGER NOT NULL,
  fault TEXT NOT NULL,
  n INTEGER NOT NULL,
  PRIMARY KEY(class, fault)
) STRICT, WITHOUT ROWID;
INSERT INTO fault_tally SELECT jobs.class, fault, count(*) FROM attempts JOIN jobs ON jobs.id = attempts.job GROUP BY 1, 2;
DROP TRIGGER count_fault;
DROP TABLE fault_counts;
CREATE TRIGGER count_fault AFTER INSERT ON attempts BEGIN
  INSERT INTO fault_tally VALUES((SELECT class FROM jobs WHERE id = new.job), new.fault, 1) ON CONFLICT DO UPDATE SET n = n + 1;
END;
)sql";

// SQLite makes a table of its own for every list of three or more words that it compares with: in the checks of a job's row that was two
// fifths of the time of writing it.
constexpr std::string_view version_3 = R"sql(
DROP TRIGGER count_fault;
CREATE TABLE jobs_3(
  id INTEGER PRIMARY KEY,
  key BLOB NOT NULL CHECK(length(key) = 32),
  campaign INTEGER NOT NULL REFERENCES campaigns(id),
  position INTEGER NOT NULL,
  class INTEGER NOT NULL REFERENCES classes(id),
  oblique INTEGER NOT NULL CHECK(oblique IN (0, 1)),  -- of which crack set
  sample_id INTEGER NOT NULL,
  state TEXT NOT NULL CHECK(state = 'LEASED' OR state = 'DONE' OR state = 'READY' OR state = 'RETRY_WAIT' OR state = 'HELD' OR state = 'QUARANTINED'
    OR state = 'CANCELLED'),
  priority INTEGER NOT NULL DEFAULT 0,
  attempts INTEGER NOT NULL DEFAULT 0,
  forgiven INTEGER NOT NULL DEFAULT 0,
  step_scale REAL NOT NULL DEFAULT 1,
  memory_floor INTEGER NOT NULL DEFAULT 0,            -- bytes a slot must have more than
  wait_s REAL,
  lease_epoch INTEGER,
  lease_counter INTEGER,
  worker INTEGER REFERENCES workers(id),
  leased_at REAL,
  verdict TEXT CHECK(verdict = 'failed' OR verdict = 'censored' OR verdict = 'rejected'),
  time_to_failure REAL,
  rule INTEGER REFERENCES rules(id),
  peak_stress REAL,
  steps INTEGER,
  cpu_s REAL,
  wall_s REAL,
  done_at REAL,
  shard INTEGER REFERENCES shards(id),
  offset INTEGER,
  length INTEGER,
  sha256 BLOB CHECK(length(sha256) = 32),
  CHECK((state = 'DONE') = (verdict IS NOT NULL)),
  CHECK(state <> 'LEASED' OR (lease_epoch IS NOT NULL AND worker IS NOT NULL)),
  CHECK(verdict IS NULL OR verdict = 'rejected' OR (shard IS NOT NULL AND sha256 IS NOT NULL)),
  CHECK(verdict IS NULL OR (verdict = 'failed') = (time_to_failure IS NOT NULL))
) STRICT;
INSERT INTO jobs_3 SELECT * FROM jobs;
DROP TABLE jobs;
ALTER TABLE jobs_3 RENAME TO jobs;
CREATE UNIQUE INDEX jobs_key ON jobs(substr(key, 1, 16));  -- half a SHA-256 is as unique, in half the space
CREATE INDEX jobs_ready ON jobs(priority DESC, id) WHERE state = 'READY';
CREATE INDEX jobs_retry ON jobs(id) WHERE state = 'RETRY_WAIT';
CREATE INDEX jobs_leased ON jobs(lease_epoch, lease_counter) WHERE state = 'LEASED';
CREATE INDEX jobs_set_aside ON jobs(state, id) WHERE state = 'HELD' OR state = 'QUARANTINED' OR state = 'CANCELLED';
CREATE TRIGGER count_new AFTER INSERT ON jobs BEGIN
  INSERT INTO counts VALUES(new.campaign, new.state, coalesce(new.verdict, ''), new.class, 1) ON CONFLICT DO UPDATE SET n = n + 1;
END;
CREATE TRIGGER count_move AFTER UPDATE OF state, verdict ON jobs WHEN old.state IS NOT new.state OR old.verdict IS NOT new.verdict BEGIN
  UPDATE counts SET n = n - 1 WHERE campaign = old.campaign AND class = old.class AND state = old.state AND verdict = coalesce(old.verdict, '');
  INSERT INTO counts VALUES(new.campaign, new.state, coalesce(new.verdict, ''), new.class, 1) ON CONFLICT DO UPDATE SET n = n + 1;
END;
CREATE TRIGGER count_fault AFTER INSERT ON attempts BEGIN
  INSERT INTO fault_tally VALUES((SELECT class FROM jobs WHERE id = new.job), new.fault, 1) ON CONFLICT DO UPDATE SET n = n + 1;
END;
)sql";

}  // namespace

std::span<const std::string_view> migrations() {
  static const std::array<std::string_view, 3> steps{schema_version_1, version_2, version_3};
  return steps;
}

Result<void> migrate(Database& database, std::span<const std::string_view> steps) {
  std::int64_t version = 0;
  {
    Rows rows = database.query("PRAGMA user_version");
    if (rows.next()) version = rows.integer(0);
  }
  if (version < 0 || version > static_cast<std::int64_t>(steps.size()))
    return fail(Fault::bad_request, fmt::format("the ledger's schema is version {}, this program knows up to {}: use the later program",
                                                version, steps.size()));
  for (auto at = static_cast<std::size_t>(version); at < steps.size(); ++at) {
    database.begin();
    database.script(std::string(steps[at]));
    database.script(fmt::format("PRAGMA user_version = {}", at + 1));
    database.commit();
  }
  return {};
}

}  // namespace fracfarm
