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

void flip_a_bit(std::string& bytes) { bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4); }
void keep_half(std::string& bytes) { bytes.resize(bytes.size() / 2); }

void ignore_the_worker(const Task& task) {
  ::signal(SIGTERM, SIG_IGN);
  for (long long step = 1;; ++step) {
    progress(task, step);
    ::usleep(10'000);
  }
}

void speak_of_another_job(Task task) {
  task.key = std::string(64, '0');
  progress(task, 1);
  wait_for_ever();
}

void say_done_without_a_record(const Task& task) {
  Summary summary;
  summary.record_sha256 = std::string(64, '0');
  done(task, summary);
}

void never_end_the_line() {
  for (;;) std::fputs("xxxxxxxxxxxxxxxx", stdout);
}

using Behaviour = std::function<void(const Task&)>;
const std::map<std::string, Behaviour> behaviours{
    {"well", solve_well},
    {"numeric", [](const Task& task) { fault(task, Fault::solver_numeric, "psi is not finite at step 7"); }},
    {"segfault", [](const Task&) { ::raise(SIGSEGV); }},
    {"killed", [](const Task&) { ::raise(SIGKILL); }},
    {"bus", bus_error},
    {"exit", [](const Task&) { std::cerr << "no more\n", std::exit(7); }},
    {"vanish", [](const Task&) { std::exit(0); }},
    {"hang", [](const Task&) { wait_for_ever(); }},
    {"work", work_until_stopped},
    {"deaf", ignore_the_worker},
    {"memory", [](const Task&) { use_memory(); }},
    {"garbage", [](const Task&) { std::puts("{\"kind\": "), std::fflush(stdout), wait_for_ever(); }},
    {"endless line", [](const Task&) { never_end_the_line(); }},
    {"other job", speak_of_another_job},
    {"grandchild", leave_a_grandchild},
    {"truncated", [](const Task& task) { solve_badly(task, keep_half, task.key); }},
    {"bit flip", [](const Task& task) { solve_badly(task, flip_a_bit, task.key); }},
    {"wrong job",
     [](const Task& task) {
       solve_badly(
           task, [](std::string&) {}, std::string(64, '0'));
     }},
    {"no record", say_done_without_a_record},
};

}  // namespace

// A sanitizer must not catch what this program does on purpose.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "handle_segv=0:handle_sigbus=0:handle_abort=0"; }

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
    const auto found = behaviours.find(always ? always : task->scene);
    if (found == behaviours.end()) return 2;
    found->second(*task);
  }
  return 0;
}
