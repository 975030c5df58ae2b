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

// mend_verbs.cpp
int run_retry(int argc, char** argv);
int run_cancel(int argc, char** argv);
int run_drain(int argc, char** argv);

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
    {"explain", "Look", "what happened to one job, and what to do", run_explain},
    {"verify", "Look", "read every record again: do ledger and shards agree", run_verify},
    {"extract", "Look", "copy records out of the store", run_extract},
    {"report", "Look", "the campaign as one HTML page in pictures", run_report},
    {"retry", "Mend", "make jobs ready again", run_retry},
    {"cancel", "Mend", "take jobs out that are not done", run_cancel},
    {"drain", "Mend", "let workers finish and end", run_drain},
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
