// A solver child that misbehaves on demand, speaking the task protocol. What it does is the task's scene text, or FAKE_SOLVER where that is
// set.
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/base/atomic_file.hpp"
#include "common/base/build_info.hpp"
#include "common/base/hash.hpp"
#include "common/record/writer.hpp"
#include "common/task/task.hpp"
#include "tests/record/sample_record.hpp"

namespace {

using namespace fracfarm;

volatile sig_atomic_t stop_asked = 0;

void say(const Report& report) {
  const std::string line = to_line(report);
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fflush(stdout);
}

void progress(const Task& task, long long step) {
  Report report;
  report.kind = Report::Kind::progress;
  report.key = task.key;
  report.step = step;
  report.horizon = 1.0;
  say(report);
}

void fault(const Task& task, Fault fault, const std::string& message) {
  Report report;
  report.kind = Report::Kind::fault;
  report.key = task.key;
  report.error = Error{fault, message};
  say(report);
}

Summary summary_of(const Record& record, const std::string& digest) {
  Summary summary;
  summary.verdict = record.judgement.verdict;
  summary.time_to_failure = record.judgement.time_to_failure;
  summary.failure_rule = record.judgement.rule;
  summary.peak_stress = as_stored(record).peak_stress;
  summary.steps = 100;
  summary.dt = 1e-7;
  summary.record_sha256 = digest;
  return summary;
}

void done(const Task& task, const Summary& summary) {
  Report report;
  report.kind = Report::Kind::done;
  report.key = task.key;
  report.summary = summary;
  say(report);
}

// Writes a sound sample record for the task, then lets `damage` at its bytes; the digest is of what `damage` left.
void solve_badly(const Task& task, const std::function<void(std::string&)>& damage, const std::string& key) {
  Record record = sample::record();
  record.key = key;
  std::string bytes = record_bytes(record).value();
  damage(bytes);
  (void)write_atomically(task.output, bytes);
  done(task, summary_of(record, sha256_hex(bytes)));
}

void solve_well(const Task& task) {
  solve_badly(
      task, [](std::string&) {}, sample::record().key);
}

[[noreturn]] void wait_for_ever() {
  for (;;) ::pause();
}

void work_until_stopped(const Task& task) {
  for (long long step = 1; !stop_asked; ++step) {
    progress(task, step);
    ::usleep(10'000);
  }
  (void)write_atomically(task.checkpoint, "checkpoint of " + task.key);
  Report report;
  report.kind = Report::Kind::stopped;
  report.key = task.key;
  say(report);
  std::exit(0);
}

void use_memory() {
  std::vector<std::unique_ptr<char[]>> all;
  for (;;) all.push_back(std::make_unique<char[]>(16 << 20));
}

void leave_a_grandchild(const Task& task) {
  if (::fork() == 0) wait_for_ever();
  std::cerr << "left one behind\n";
  progress(task, 1);
  ::abort();
}

// Reads a page of a file that was cut after it was mapped.
void bus_error(const Task& task) {
  const std::string path = task.output.string() + ".map";
  std::ofstream(path) << std::string(8192, 'x');
  std::FILE* file = std::fopen(path.c_str(), "r+");
  auto* page = static_cast<volatile char*>(::mmap(nullptr, 8192, PROT_READ, MAP_SHARED, ::fileno(file), 0));
  (void)!::ftruncate(::fileno(file), 0);
  std::cerr << page[4096];
}

const std::map<std::string, std::function<void(const Task&)>>& behaviours() {
  static const std::map<std::string, std::function<void(const Task&)>> table{
      {"well", solve_well},
      {"numeric", [](const Task& t) { fault(t, Fault::solver_numeric, "psi is not finite at step 7"); }},
      {"segfault", [](const Task&) { ::raise(SIGSEGV); }},
      {"killed", [](const Task&) { ::raise(SIGKILL); }},
      {"bus", bus_error},
      {"exit",
       [](const Task&) {
         std::cerr << "no more\n";
         std::exit(7);
       }},
      {"vanish", [](const Task&) { std::exit(0); }},
      {"hang", [](const Task&) { wait_for_ever(); }},
      {"work", work_until_stopped},
      {"deaf",
       [](const Task& t) {
         ::signal(SIGTERM, SIG_IGN);
         for (long long s = 1;; ++s) progress(t, s), ::usleep(10'000);
       }},
      {"memory", [](const Task&) { use_memory(); }},
      {"garbage",
       [](const Task&) {
         std::puts("{\"kind\": ");
         std::fflush(stdout);
         wait_for_ever();
       }},
      {"endless line",
       [](const Task&) {
         for (;;) std::fputs("xxxxxxxxxxxxxxxx", stdout);
       }},
      {"other job",
       [](const Task& t) {
         Task other = t;
         other.key = std::string(64, '0');
         progress(other, 1);
         wait_for_ever();
       }},
      {"grandchild", leave_a_grandchild},
      {"truncated",
       [](const Task& t) {
         solve_badly(
             t, [](std::string& b) { b.resize(b.size() / 2); }, t.key);
       }},
      {"bit flip",
       [](const Task& t) {
         solve_badly(
             t, [](std::string& b) { b[b.size() / 2] = static_cast<char>(b[b.size() / 2] ^ 4); }, t.key);
       }},
      {"wrong job",
       [](const Task& t) {
         solve_badly(
             t, [](std::string&) {}, std::string(64, '0'));
       }},
      {"no record",
       [](const Task& t) {
         Summary s;
         s.record_sha256 = std::string(64, '0');
         done(t, s);
       }},
  };
  return table;
}

}  // namespace

int main() {
  ::signal(SIGTERM, [](int) { stop_asked = 1; });
  const char* always = std::getenv("FAKE_SOLVER");
  if (always && std::string(always) == "never ready") wait_for_ever();
  if (always && std::string(always) == "missing library") {
    std::cerr << "fracfarm-solve: error while loading shared libraries: libhdf5.so.103: cannot open shared object file\n";
    return 127;
  }
  Report ready;
  ready.build_id = build_info().build_id;
  say(ready);
  for (std::string line; std::getline(std::cin, line);) {
    const auto task = task_from_line(line);
    if (!task) return 2;
    const auto found = behaviours().find(always ? always : task->scene);
    if (found == behaviours().end()) return 2;
    found->second(*task);
  }
  return 0;
}
