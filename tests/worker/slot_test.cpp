#include "worker/slot.hpp"

#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "common/base/build_info.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::worker;

namespace {

constexpr double patience_s = 20.0;  // of the tests themselves

struct Bench {
  TempFarm folder;
  SystemClock clock;
  SlotOptions options;
  std::optional<Slot> slot;
  std::vector<SlotEvent> seen;

  Bench() {
    options.solver = std::string(FRACFARM_BIN_DIR) + "/fake_solver";
    options.arguments = {};
  }
  void start(const std::string& behaviour, double wall_budget_s = 1000.0) {
    if (!slot) slot.emplace(options, clock);
    Task task;
    task.key = std::string(64, 'a');
    task.scene = behaviour;
    task.output = folder.path / "a.h5";
    task.checkpoint = folder.path / "a.ckpt";
    task.wall_budget_s = wall_budget_s;
    slot->start(task);
  }
  // The first event of this kind.
  template <class Kind>
  Kind wait_for() {
    const double deadline = clock.monotonic_s() + patience_s;
    while (clock.monotonic_s() < deadline) {
      for (SlotEvent& event : slot->step()) seen.push_back(std::move(event));
      for (const SlotEvent& event : seen)
        if (const auto* kind = std::get_if<Kind>(&event)) {
          Kind found = *kind;
          seen.clear();
          return found;
        }
      ::usleep(2000);
    }
    FAIL("the event did not come");
    return {};
  }
};

}  // namespace

TEST_CASE("a child says which build it is and is kept alive between jobs") {
  Bench bench;
  bench.start("well");
  CHECK(bench.wait_for<SlotReady>().build_id == build_info().build_id);
  const auto first = bench.slot->pid();
  CHECK(bench.wait_for<SlotSolved>().summary.steps == 100);
  CHECK_FALSE(bench.slot->busy());
  bench.start("numeric");
  const auto failed = bench.wait_for<SlotFailed>();
  CHECK(failed.fault == Fault::solver_numeric);
  CHECK(failed.message == "psi is not finite at step 7");
  CHECK(failed.signature == "reported SOLVER_NUMERIC");
  bench.start("well");
  bench.wait_for<SlotSolved>();
  CHECK(bench.slot->pid() == first);
}

TEST_CASE("each way for a child to end is one row of the fault table") {
  struct Row {
    const char* behaviour;
    Fault fault;
    const char* signature;
  };
  const Row row =
      GENERATE(Row{"segfault", Fault::solver_crash, "SIGSEGV"}, Row{"killed", Fault::solver_crash, "SIGKILL"},
               Row{"bus", Fault::node_lost, "SIGBUS"}, Row{"exit", Fault::solver_crash, "exit 7"},
               Row{"vanish", Fault::solver_crash, "exit 0"}, Row{"garbage", Fault::solver_crash, "unreadable report"},
               Row{"endless line", Fault::solver_crash, "unreadable report"}, Row{"other job", Fault::solver_crash, "unreadable report"});
  CAPTURE(row.behaviour);
  Bench bench;
  bench.start(row.behaviour);
  const auto failed = bench.wait_for<SlotFailed>();
  CHECK(failed.fault == row.fault);
  CHECK(failed.signature == row.signature);
  CHECK_FALSE(bench.slot->busy());
  bench.start("well");  // the slot goes on with another child
  bench.wait_for<SlotSolved>();
}

TEST_CASE("the last words of a child are in the message") {
  Bench bench;
  bench.start("exit");
  CHECK(bench.wait_for<SlotFailed>().message == "the solver ended with status 7; its last words: no more");
}

#ifndef __SANITIZE_ADDRESS__  // the sanitizer itself needs terabytes of address space
TEST_CASE("a child beyond its memory limit is OUT_OF_MEMORY") {
  Bench bench;
  bench.options.memory_limit = 512u << 20;
  bench.start("memory");
  const auto failed = bench.wait_for<SlotFailed>();
  CHECK(failed.fault == Fault::out_of_memory);
  CHECK(failed.signature == "memory");
}
#endif

TEST_CASE("a child that says nothing is killed as hung") {
  Bench bench;
  bench.options.hang_s = 0.2;
  bench.start("hang");
  const auto failed = bench.wait_for<SlotFailed>();
  CHECK(failed.fault == Fault::solver_crash);
  CHECK(failed.signature == "hang");
}

TEST_CASE("a child that reports progress is not hung") {
  Bench bench;
  bench.options.hang_s = 0.5;
  bench.start("work");
  const double until = bench.clock.monotonic_s() + 1.2;
  while (bench.clock.monotonic_s() < until) CHECK(bench.wait_for<SlotProgress>().step > 0);
  CHECK(bench.slot->busy());
}

TEST_CASE("stopping a child leaves a checkpoint and no fault") {
  Bench bench;
  bench.start("work");
  bench.wait_for<SlotProgress>();
  bench.slot->stop();
  bench.wait_for<SlotStopped>();
  CHECK(std::filesystem::exists(bench.folder.path / "a.ckpt"));
  CHECK(bench.slot->pid() == -1);
}

TEST_CASE("a child that is deaf to SIGTERM is killed after the grace, as a planned stop") {
  Bench bench;
  bench.options.stop_grace_s = 0.2;
  bench.start("deaf");
  bench.wait_for<SlotProgress>();
  bench.slot->stop();
  bench.wait_for<SlotStopped>();
}

TEST_CASE("a child that ignores its wall budget is ended from outside, and that is the solver's fault") {
  const std::string behaviour = GENERATE("deaf", "work");
  Bench bench;
  bench.options.budget_grace_s = 0.1;
  bench.options.stop_grace_s = 0.2;
  bench.start(behaviour, 0.2);
  const auto failed = bench.wait_for<SlotFailed>();
  CHECK(failed.fault == Fault::solver_crash);
  CHECK(failed.signature == "wall_budget");
}

TEST_CASE("an abandoned task is killed at once and counts as nothing") {
  Bench bench;
  bench.start("deaf");
  bench.wait_for<SlotProgress>();
  bench.slot->abandon();
  bench.wait_for<SlotStopped>();
}

TEST_CASE("a crashed child's own children go with it") {
  Bench bench;
  bench.start("grandchild");
  const pid_t group = bench.slot->pid();
  bench.wait_for<SlotFailed>();
  bool gone = false;
  for (int i = 0; i < 500 && !gone; ++i, ::usleep(10'000)) gone = ::kill(-group, 0) != 0;
  CHECK(gone);
}

TEST_CASE("a program that cannot run, lacks a library or never gets ready is the node's fault or a hang") {
  Bench bench;
  SECTION("not there") {
    bench.options.solver = bench.folder.path / "nothing";
    bench.start("well");
    const auto failed = bench.wait_for<SlotFailed>();
    CHECK(failed.fault == Fault::node_lost);
    CHECK(failed.message.find("No such file") != std::string::npos);
  }
  SECTION("missing library") {
    ::setenv("FAKE_SOLVER", "missing library", 1);
    bench.start("well");
    ::unsetenv("FAKE_SOLVER");
    CHECK(bench.wait_for<SlotFailed>().fault == Fault::node_lost);
  }
  SECTION("never ready") {
    bench.options.start_s = 0.2;
    ::setenv("FAKE_SOLVER", "never ready", 1);
    bench.start("well");
    ::unsetenv("FAKE_SOLVER");
    CHECK(bench.wait_for<SlotFailed>().signature == "hang");
  }
}

TEST_CASE("the kernel's kill for memory is told from any other SIGKILL by its evidence") {
  EndEvidence end;
  end.status = SIGKILL;  // as waitpid gives "ended by signal 9"
  CHECK(classify(end).fault == Fault::solver_crash);
  end.oom_kill_counted = true;
  CHECK(classify(end).fault == Fault::out_of_memory);
  end.oom_kill_counted = false;
  end.memory_limit = 1000;
  end.peak_rss = 950;
  CHECK(classify(end).fault == Fault::out_of_memory);
  end.peak_rss = 500;
  CHECK(classify(end).fault == Fault::solver_crash);
}
