#include "tests/system/farm_bench.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>

#include "common/base/clock.hpp"

namespace fracfarm::bench {
namespace {

namespace fs = std::filesystem;

// In the environment of everything that a bench starts, and of what that starts in turn.
std::string marker(const fs::path& folder) { return "FRACFARM_BENCH=" + folder.string() + '\0'; }

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<pid_t> processes_of(const fs::path& folder) {
  std::vector<pid_t> pids;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") == std::string::npos &&
        text_of(entry.path() / "environ").find(marker(folder)) != std::string::npos)
      pids.push_back(std::stoi(name));
  }
  return pids;
}

[[noreturn]] void become(const std::vector<std::string>& command, const fs::path& log,
                         const std::map<std::string, std::string>& environment) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
  const int out = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(out, STDERR_FILENO);
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  ::execv(words[0], words.data());
  ::_exit(127);
}

}  // namespace

Process::Process(const std::vector<std::string>& command, const fs::path& log, const std::map<std::string, std::string>& environment) {
  pid_ = ::fork();
  REQUIRE(pid_ >= 0);
  if (pid_ == 0) become(command, log, environment);
  ::setpgid(pid_, pid_);
}

Process::~Process() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  if (!status_) ::waitpid(pid_, nullptr, 0);
}

Process::Process(Process&& other) noexcept : pid_(std::exchange(other.pid_, -1)), status_(other.status_) {}
Process& Process::operator=(Process&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(status_, other.status_);
  return *this;
}

void Process::signal(int number) const { ::kill(pid_, number); }
void Process::signal_group(int number) const { ::kill(-pid_, number); }

bool Process::running() {
  if (status_) return false;
  int raw = 0;
  if (::waitpid(pid_, &raw, WNOHANG) != pid_) return true;
  status_ = WIFSIGNALED(raw) ? 128 + WTERMSIG(raw) : WEXITSTATUS(raw);
  return false;
}

int Process::wait(double timeout_s) {
  REQUIRE(wait_until([&] { return !running(); }, timeout_s));
  return *status_;
}

void sleep_s(double seconds) { ::usleep(static_cast<useconds_t>(seconds * 1e6)); }

bool wait_until(const std::function<bool()>& holds, double timeout_s) {
  SystemClock clock;
  const double deadline = clock.monotonic_s() + timeout_s;
  while (!holds()) {
    if (clock.monotonic_s() > deadline) return false;
    sleep_s(0.02);
  }
  return true;
}

FarmBench::FarmBench() { fs::create_directories(farm()); }

FarmBench::~FarmBench() {
  if (Catch::getResultCapture().lastAssertionPassed() && std::uncaught_exceptions() == 0) return;
  for (const auto& entry : fs::directory_iterator(folder()))
    if (entry.path().extension() == ".log") std::cerr << "--- " << entry.path().filename() << "\n" << text_of(entry.path());
}

fs::path FarmBench::next_log(const std::string& name) { return folder() / fmt::format("{:02}-{}.log", logs_++, name); }

fs::path FarmBench::campaign(const Campaign& c) {
  const fs::path path = folder() / fmt::format("campaign-{}.toml", logs_++);
  std::ofstream(path) << "name = \"system\"\nseed = 7\n[[jobs]]\nmethod = \"phase_field\"\nmaterials = " << c.materials
                      << "\nloads = " << c.loads << "\npatterns = { orthogonal = \"1-" << c.patterns << "\" }\nset = { " << c.set
                      << " }\n[budget]\nwall_clock = \"" << c.wall_clock << "\"\nattempts = " << c.attempts
                      << "\n[output]\nstore = \"store\"\n";
  return path;
}

Process FarmBench::start(std::vector<std::string> words, const std::map<std::string, std::string>& environment) {
  const fs::path log = next_log(words.front());
  words.insert(words.begin(), std::string(FRACFARM_BIN_DIR) + "/fracfarm");
  words.insert(words.end(), {"--farm", farm().string()});
  auto marked = environment;
  marked["FRACFARM_BENCH"] = folder().string();
  return Process(words, log, marked);
}

FarmBench::Outcome FarmBench::verb(std::vector<std::string> words) {
  const fs::path log = folder() / fmt::format("verb-{}.out", logs_++);
  words.insert(words.begin(), std::string(FRACFARM_BIN_DIR) + "/fracfarm");
  words.insert(words.end(), {"--farm", farm().string()});
  Process process(words, log);
  const int status = process.wait();
  Outcome outcome{status, text_of(log)};
  fs::remove(log);
  return outcome;
}

nlohmann::json FarmBench::json(std::vector<std::string> words) {
  words.push_back("--json");
  const Outcome outcome = verb(std::move(words));
  INFO(outcome.output);
  const auto body = nlohmann::json::parse(outcome.output, nullptr, false);
  REQUIRE(body.is_object());
  return body;
}

void FarmBench::submit(const Campaign& c) {
  const Outcome outcome = verb({"submit", campaign(c).string()});
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
}

Process FarmBench::coordinator(std::vector<std::string> more) {
  more.insert(more.begin(), "coordinator");
  return start(std::move(more));
}

Process FarmBench::worker(std::vector<std::string> more, const std::map<std::string, std::string>& environment) {
  more.insert(more.begin(), "worker");
  return start(std::move(more), environment);
}

int FarmBench::done() {
  const auto outcome = verb({"status", "--json"});
  const auto body = nlohmann::json::parse(outcome.output, nullptr, false);
  return body.is_object() && body.contains("counts") ? body["counts"].value("done", -1) : -1;
}

std::vector<nlohmann::json> FarmBench::jobs() { return json({"jobs", "--limit", "10000"})["jobs"].get<std::vector<nlohmann::json>>(); }

nlohmann::json FarmBench::explain(int job) { return json({"explain", std::to_string(job)}); }

std::map<int, int> FarmBench::starts() const {
  std::map<int, int> counts;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(farm() / "log", none)) {
    if (!entry.path().filename().string().starts_with("worker-")) continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const auto said = nlohmann::json::parse(line, nullptr, false);
      if (said.is_object() && said.value("event", "") == "started") ++counts[said["job"].get<int>()];
    }
  }
  return counts;
}

std::vector<long long> FarmBench::steps_logged(const std::string& event) const {
  std::vector<long long> steps;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(farm() / "log", none)) {
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const auto said = nlohmann::json::parse(line, nullptr, false);
      if (said.is_object() && said.value("event", "") == event) steps.push_back(std::stoll(said["detail"].get<std::string>().substr(8)));
    }
  }
  return steps;
}

bool FarmBench::logged(const std::string& text) const {
  std::error_code none;  // it may not be there yet
  for (const auto& entry : fs::directory_iterator(farm() / "log", none))
    if (text_of(entry.path()).find(text) != std::string::npos) return true;
  return false;
}

void FarmBench::power_cut() const {
  for (const pid_t pid : processes_of(folder())) ::kill(pid, SIGKILL);
}

int FarmBench::processes_alive() const { return static_cast<int>(processes_of(folder()).size()); }

int FarmBench::solvers_alive() const {
  int alive = 0;
  for (const pid_t pid : processes_of(folder()))
    if (text_of(fs::path("/proc") / std::to_string(pid) / "cmdline").find("--serve") != std::string::npos) ++alive;
  return alive;
}

void FarmBench::check_all_done(int expected) {
  const auto status = json({"status"});
  std::set<std::string> keys;
  std::map<std::string, int> states, verdicts;
  for (const auto& job : jobs()) {
    keys.insert(job["key"].get<std::string>());
    ++states[job["state"].get<std::string>()];
    if (job["verdict"].is_string()) ++verdicts[job["verdict"].get<std::string>()];
  }
  CHECK(static_cast<int>(keys.size()) == expected);
  CHECK(states == std::map<std::string, int>{{"done", expected}});
  for (const auto& [state, count] : status["counts"].items()) CHECK(count.get<int>() == states[state]);
  for (const auto& [verdict, count] : status["verdicts"].items()) CHECK(count.get<int>() == verdicts[verdict]);
  CHECK(status["total"].get<int>() == expected);
  CHECK(status["alarms"].empty());
  const Outcome verified = verb({"verify"});
  INFO(verified.output);
  CHECK(verified.status == 0);
  CHECK(wait_until([&] { return solvers_alive() == 0; }, 5.0));
}

}  // namespace fracfarm::bench
