#include "coordinator/cli/verb.hpp"

#include <array>

namespace fracfarm::cli {

// campaign_verbs.cpp, run_verb.cpp
int run_plan(int argc, char** argv);
int run_submit(int argc, char** argv);
int run_run(int argc, char** argv);

// look_verbs.cpp, verify_verb.cpp
int run_status(int argc, char** argv);
int run_jobs(int argc, char** argv);
int run_explain(int argc, char** argv);
int run_verify(int argc, char** argv);

// failures_verb.cpp, metrics_verb.cpp, doctor_verb.cpp
int run_failures(int argc, char** argv);
int run_metrics(int argc, char** argv);
int run_doctor(int argc, char** argv);

// class_verbs.cpp
int run_pause(int argc, char** argv);
int run_resume(int argc, char** argv);
int run_recheck(int argc, char** argv);

// keep_verbs.cpp
int run_backup(int argc, char** argv);
int run_restore(int argc, char** argv);
int run_rebuild(int argc, char** argv);

// mend_verbs.cpp
int run_retry(int argc, char** argv);
int run_hold(int argc, char** argv);
int run_release(int argc, char** argv);
int run_priority(int argc, char** argv);
int run_cancel(int argc, char** argv);
int run_drain(int argc, char** argv);

// drill_verb.cpp
int run_drill(int argc, char** argv);

// extract_verb.cpp, report_verb.cpp
int run_extract(int argc, char** argv);
int run_report(int argc, char** argv);

// record_verbs.cpp
int run_check(int argc, char** argv);
int run_show(int argc, char** argv);

// scene_verbs.cpp
int run_pattern(int argc, char** argv);
int run_scene(int argc, char** argv);

namespace {

constexpr auto table = std::to_array<Verb>({
    {"run", "Run a campaign", "submit a campaign and work it off on this machine", run_run},
    {"plan", "Run a campaign", "what a campaign would run, and what it costs", run_plan},
    {"submit", "Run a campaign", "put the jobs of a campaign into the ledger", run_submit},
    {"status", "Look", "counts, rate, time left, faults, workers", run_status},
    {"jobs", "Look", "a table of jobs", run_jobs},
    {"explain", "Look", "what happened to one job or worker, and what to do", run_explain},
    {"failures", "Look", "how tries ended badly, and what stands out among them", run_failures},
    {"verify", "Look", "read every record again: do ledger and shards agree", run_verify},
    {"doctor", "Look", "is this machine fit to serve or work: disks, clock, keys, limits", run_doctor},
    {"metrics", "Look", "the status as Prometheus text", run_metrics},
    {"extract", "Look", "copy records out of the store", run_extract},
    {"report", "Look", "the campaign as one HTML page in pictures", run_report},
    {"retry", "Mend", "make jobs ready again", run_retry},
    {"hold", "Mend", "keep jobs from being handed out", run_hold},
    {"release", "Mend", "make held jobs ready", run_release},
    {"priority", "Mend", "which jobs come first", run_priority},
    {"cancel", "Mend", "take jobs out that are not done", run_cancel},
    {"pause", "Mend", "hand out nothing more of a class", run_pause},
    {"resume", "Mend", "paused classes go on", run_resume},
    {"recheck", "Mend", "compute jobs that are done again: to compare, or to repair", run_recheck},
    {"drain", "Mend", "let workers finish and end", run_drain},
    {"backup", "Keep", "copy the ledger while it is in use", run_backup},
    {"restore", "Keep", "put a copy back, and adopt what the shards have since", run_restore},
    {"rebuild", "Keep", "make a ledger from the shards alone", run_rebuild},
    {"drill", "Keep", "rehearse every fault on a farm of its own", run_drill},
    {"solve", "One simulation", "solve one scene and write its record", nullptr},
    {"mesh", "One simulation", "make, measure and draw the FDEM mesh of a scene", nullptr},
    {"check", "One simulation", "is this record sound: name every broken rule", run_check},
    {"show", "One simulation", "what a record holds, in words or as a picture", run_show},
    {"scene", "One simulation", "print the scene of one sample, or check a scene file", run_scene},
    {"pattern", "One simulation", "print one random crack pattern", run_pattern},
    {"coordinator", "Daemons", "keep the ledger and hand out jobs", nullptr},
    {"worker", "Daemons", "solve jobs on this node", nullptr},
});

}  // namespace

std::span<const Verb> verbs() { return table; }

}  // namespace fracfarm::cli
