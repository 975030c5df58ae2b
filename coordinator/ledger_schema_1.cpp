// The ledger's first tables, from which every older ledger came.
#include "coordinator/ledger_schema_1.hpp"

namespace fracfarm {

const std::string_view schema_version_1 = R"sql(
CREATE TABLE meta(
  name TEXT PRIMARY KEY,   -- farm_id, epoch, build_id
  value TEXT NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE campaigns(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  text TEXT NOT NULL,                 -- canonical
  build_id TEXT NOT NULL,             -- of the solver that its jobs are for
  total INTEGER NOT NULL CHECK(total >= 0),
  expanded INTEGER NOT NULL DEFAULT 0 CHECK(expanded BETWEEN 0 AND total),  -- positions below it have been made jobs
  shared INTEGER NOT NULL DEFAULT 0 CHECK(shared BETWEEN 0 AND expanded),   -- of these, keys that the ledger had already
  submitted_at REAL NOT NULL,
  UNIQUE(text, build_id)
) STRICT;

CREATE TABLE workers(                 -- one row for each start of a worker
  id INTEGER PRIMARY KEY,
  peer TEXT NOT NULL,                 -- authenticated name of its key
  instance TEXT NOT NULL,
  node TEXT NOT NULL,
  slots INTEGER NOT NULL,
  memory_bytes INTEGER NOT NULL,
  build_id TEXT NOT NULL,
  began_at REAL NOT NULL,
  ended_at REAL,                      -- BYE, or a later instance of the same peer
  draining INTEGER NOT NULL DEFAULT 0 CHECK(draining IN (0, 1)),
  done INTEGER NOT NULL DEFAULT 0,
  faults INTEGER NOT NULL DEFAULT 0,
  UNIQUE(peer, instance)
) STRICT;

CREATE TABLE shards(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
) STRICT;

CREATE TABLE jobs(
  id INTEGER PRIMARY KEY,
  key BLOB NOT NULL UNIQUE CHECK(length(key) = 32),
  campaign INTEGER NOT NULL REFERENCES campaigns(id),
  position INTEGER NOT NULL,
  method TEXT NOT NULL,
  material TEXT NOT NULL,
  load TEXT NOT NULL,
  crack_set TEXT NOT NULL,
  sample_id INTEGER NOT NULL,
  state TEXT NOT NULL CHECK(state IN ('HELD','READY','LEASED','DONE','RETRY_WAIT','QUARANTINED','CANCELLED')),
  priority INTEGER NOT NULL DEFAULT 0,
  attempts INTEGER NOT NULL DEFAULT 0,
  forgiven INTEGER NOT NULL DEFAULT 0,
  step_scale REAL NOT NULL DEFAULT 1,
  wait_s REAL,
  lease_epoch INTEGER,
  lease_counter INTEGER,
  worker INTEGER REFERENCES workers(id),
  leased_at REAL,
  verdict TEXT CHECK(verdict IN ('failed','censored','rejected')),
  time_to_failure REAL,
  failure_rule TEXT,
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
CREATE INDEX jobs_ready ON jobs(priority DESC, id) WHERE state = 'READY';
CREATE INDEX jobs_retry ON jobs(id) WHERE state = 'RETRY_WAIT';
CREATE INDEX jobs_leased ON jobs(lease_epoch, lease_counter) WHERE state = 'LEASED';
CREATE INDEX jobs_quarantined ON jobs(id) WHERE state = 'QUARANTINED';

CREATE TABLE attempts(                -- how tries ended that did not end in a result
  id INTEGER PRIMARY KEY,
  job INTEGER NOT NULL REFERENCES jobs(id),
  attempt INTEGER NOT NULL,
  worker INTEGER REFERENCES workers(id),
  fault TEXT NOT NULL CHECK(fault IN ('PLANNED_STOP','NODE_LOST','OUTPUT_BAD','SOLVER_CRASH','SOLVER_NUMERIC','OUT_OF_MEMORY','BUDGET','BAD_REQUEST')),
  signature TEXT NOT NULL,
  message TEXT NOT NULL,
  began_at REAL,
  ended_at REAL NOT NULL
) STRICT;
CREATE INDEX attempts_job ON attempts(job);

CREATE TABLE alarms(
  id INTEGER PRIMARY KEY,
  kind TEXT NOT NULL CHECK(kind IN ('NONDETERMINISM')),
  job INTEGER NOT NULL REFERENCES jobs(id),
  message TEXT NOT NULL,
  raised_at REAL NOT NULL
) STRICT;

CREATE TABLE durations(               -- learned: wall seconds of results, in quarter octaves
  method TEXT NOT NULL,
  material TEXT NOT NULL,
  load TEXT NOT NULL,
  bin INTEGER NOT NULL,               -- floor(4 log2(seconds))
  n INTEGER NOT NULL,
  wall_s REAL NOT NULL,
  bytes INTEGER NOT NULL,
  PRIMARY KEY(method, material, load, bin)
) STRICT, WITHOUT ROWID;

CREATE TABLE counts(
  campaign INTEGER NOT NULL,
  state TEXT NOT NULL,
  verdict TEXT NOT NULL,              -- '' unless DONE
  method TEXT NOT NULL,
  material TEXT NOT NULL,
  load TEXT NOT NULL,
  n INTEGER NOT NULL CHECK(n >= 0),
  PRIMARY KEY(campaign, state, verdict, method, material, load)
) STRICT, WITHOUT ROWID;
CREATE TRIGGER count_new AFTER INSERT ON jobs BEGIN
  INSERT INTO counts VALUES(new.campaign, new.state, coalesce(new.verdict, ''), new.method, new.material, new.load, 1)
    ON CONFLICT DO UPDATE SET n = n + 1;
END;
CREATE TRIGGER count_move AFTER UPDATE OF state, verdict ON jobs WHEN old.state IS NOT new.state OR old.verdict IS NOT new.verdict BEGIN
  UPDATE counts SET n = n - 1 WHERE campaign = old.campaign AND state = old.state AND verdict = coalesce(old.verdict, '')
    AND method = old.method AND material = old.material AND load = old.load;
  INSERT INTO counts VALUES(new.campaign, new.state, coalesce(new.verdict, ''), new.method, new.material, new.load, 1)
    ON CONFLICT DO UPDATE SET n = n + 1;
END;

CREATE TABLE fault_counts(
  fault TEXT PRIMARY KEY,
  n INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
CREATE TRIGGER count_fault AFTER INSERT ON attempts BEGIN
  INSERT INTO fault_counts VALUES(new.fault, 1) ON CONFLICT DO UPDATE SET n = n + 1;
END;
)sql";

}  // namespace fracfarm
