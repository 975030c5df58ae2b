// fracfarm-farm-throughput: what a farm's bookkeeping costs, measured on this machine with the programs as they are: real coordinator,
// CURVE, every commit synced, simulated workers as processes of their own that do their jobs in no time. Beside it, in the same run, what
// GNU parallel and Dask distributed make of jobs that do nothing, where they are installed. Prints one table and judges no figure.
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "common/base/build_info.hpp"
#include "common/base/hash.hpp"
#include "common/base/terminal.hpp"
#include "common/wire/endpoint.hpp"
#include "common/wire/keys.hpp"
#include "common/wire/socket.hpp"

namespace fs = std::filesystem;
using namespace fracfarm;
using Steady = std::chrono::steady_clock;

namespace {

struct Options {
  fs::path folder;  // of the farm: on the disk that is to be measured
  std::uint64_t jobs = 2'090'000;
  int workers = 64;
  double seconds = 10.0;  // of each batch size
  std::string method = "drill";
  bool others = true;  // GNU parallel and Dask
};

double since(Steady::time_point then) { return std::chrono::duration<double>(Steady::now() - then).count(); }

std::string beside(const std::string& name) { return fs::read_symlink("/proc/self/exe").parent_path() / name; }

// --- processes ---

pid_t start(const std::vector<std::string>& words, const fs::path& output) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  if (std::freopen(output.c_str(), "a", stdout) && std::freopen(output.c_str(), "a", stderr)) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    ::execvp(argv[0], argv.data());
  }
  ::_exit(127);
}

int wait_for(pid_t pid) {
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

struct Timed {
  int status = 0;
  double seconds = 0.0;
  std::string output;
};
Timed timed(const std::vector<std::string>& words, const fs::path& output) {
  fs::remove(output);
  const auto began = Steady::now();
  Timed run;
  run.status = wait_for(start(words, output));
  run.seconds = since(began);
  std::ifstream file(output);
  run.output.assign(std::istreambuf_iterator<char>(file), {});
  return run;
}

// Of all threads of a process, by /proc.
double cpu_seconds(const std::string& process) {
  std::ifstream file("/proc/" + process + "/stat");
  std::string words(std::istreambuf_iterator<char>(file), {});
  std::istringstream after_name(words.substr(std::min(words.size(), words.rfind(')') + 1)));
  std::string skipped;
  double user = 0.0, system = 0.0;
  for (int n = 0; n < 11; ++n) after_name >> skipped;
  after_name >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

// --- a worker that does its jobs in no time ---

struct Tally {
  std::uint64_t done = 0;
  std::uint64_t done_after = 0;  // reported when the time was over
  double cpu_s = 0.0;
  std::array<std::uint32_t, 2000> claim_ms10{};  // claims by tenths of a millisecond
};

wire::Completion done(const wire::Assignment& it, std::uint64_t n) {
  return {it.lease, it.key,           Verdict::censored, std::nullopt, "horizon",         1e6, 10, 0.0,
          0.0,      "throughput.tar", 512 * n,           300,          sha256_hex(it.key)};
}

Tally work(const Options& options, int number, int batch, double seconds) {
  Tally tally;
  const auto key = wire::load_or_make_key(options.folder, fmt::format("worker-{}", number));
  const auto endpoint = wire::read_endpoint(options.folder);
  if (!key || !endpoint) return tally;
  auto client = wire::Client::connect(endpoint->endpoint, options.folder, *key);
  if (!client) return tally;
  const auto hello = wire::Hello{
      fmt::format("node-{}", number), fmt::format("{}-{}-{}", number, batch, ::getpid()), batch, 1u << 30, build_info().build_id, -1.0, {}};
  if (const auto welcome = client->ask(hello, 60.0); !welcome) {
    if (number == 0) fmt::print(stderr, "{}\n", welcome.error().message);  // the others hear the same
    return tally;
  }
  std::vector<wire::Completion> finished;
  const auto began = Steady::now();
  for (std::uint64_t n = 0; since(began) < seconds;) {
    const std::size_t reported = finished.size();
    const auto asked = Steady::now();
    const auto reply = client->ask(wire::Next{finished, {}, {}, batch, -1.0}, 60.0);
    const auto* jobs = reply ? std::get_if<wire::Jobs>(&*reply) : nullptr;
    if (!jobs) break;
    ++tally.claim_ms10[std::min<std::size_t>(tally.claim_ms10.size() - 1, static_cast<std::size_t>(1e4 * since(asked)))];
    tally.done += reported;
    finished.clear();
    for (const wire::Assignment& it : jobs->assignments) finished.push_back(done(it, ++n));
    if (jobs->assignments.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  tally.cpu_s = cpu_seconds("self");
  if (client->ask(wire::Next{finished, {}, {}, 0, -1.0}, 60.0)) tally.done_after = finished.size();
  (void)client->ask(wire::Bye{}, 10.0);
  return tally;
}

struct Rate {
  double jobs_per_s = 0.0, p50_ms = 0.0, p99_ms = 0.0;
  std::uint64_t done = 0;
  double worker_us = 0.0;  // of the processors, a job
};

// The workers begin together and measure over the same seconds.
Rate measure(const Options& options, int batch) {
  std::vector<std::pair<pid_t, int>> workers;
  for (int n = 0; n < options.workers; ++n) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) break;
    const pid_t pid = ::fork();
    if (pid == 0) {
      ::close(pipe[0]);
      const Tally tally = work(options, n, batch, options.seconds);
      (void)!::write(pipe[1], &tally, sizeof tally);
      ::_exit(0);
    }
    ::close(pipe[1]);
    workers.emplace_back(pid, pipe[0]);
  }
  Tally all;
  for (const auto& [pid, input] : workers) {
    Tally one;
    auto* bytes = reinterpret_cast<char*>(&one);
    for (std::size_t at = 0; at < sizeof one;) {
      const ssize_t got = ::read(input, bytes + at, sizeof one - at);
      if (got <= 0) break;
      at += static_cast<std::size_t>(got);
    }
    ::close(input);
    wait_for(pid);
    all.done += one.done;
    all.done_after += one.done_after;
    all.cpu_s += one.cpu_s;
    for (std::size_t at = 0; at < one.claim_ms10.size(); ++at) all.claim_ms10[at] += one.claim_ms10[at];
  }
  std::uint64_t claims = 0, seen = 0;
  for (const std::uint32_t n : all.claim_ms10) claims += n;
  Rate rate{static_cast<double>(all.done) / options.seconds, 0.0, 0.0, all.done + all.done_after, 0.0};
  rate.worker_us = 1e6 * all.cpu_s / static_cast<double>(std::max<std::uint64_t>(1, rate.done));
  for (std::size_t at = 0; at < all.claim_ms10.size(); ++at) {
    seen += all.claim_ms10[at];
    const double top_ms = 0.1 * static_cast<double>(at + 1);
    if (rate.p50_ms == 0.0 && 2 * seen >= claims) rate.p50_ms = top_ms;
    if (rate.p99_ms == 0.0 && 100 * seen >= 99 * claims) rate.p99_ms = top_ms;
  }
  return rate;
}

// --- the farm ---

struct Coordinator {
  pid_t pid = -1;
  explicit Coordinator(const Options& options) {
    fs::remove(options.folder / "endpoint.json");
    pid = start({beside("fracfarm-coordinator"), "--farm", options.folder, "--quiet", "--backup-every", "0", "--audit", "0"},
                options.folder / "coordinator.out");
    while (!wire::read_endpoint(options.folder) && ::kill(pid, 0) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~Coordinator() { end(SIGTERM); }
  void end(int signal) {
    if (pid > 0) ::kill(pid, signal), wait_for(pid);
    pid = -1;
  }
  double cpu_s() const { return cpu_seconds(std::to_string(pid)); }
  double peak_mb() const {
    std::ifstream file(fmt::format("/proc/{}/status", pid));
    for (std::string line; std::getline(file, line);)
      if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
    return 0.0;
  }
};

// A drill breaks no body: it has neither materials nor loads.
fs::path write_campaign(const Options& options) {
  const fs::path file = options.folder / "campaign.json";
  nlohmann::json block{{"method", options.method}};
  std::uint64_t jobs_a_pattern = 1;
  if (options.method != "drill") {
    block["materials"] = {"pbx", "steel", "aluminum", "tungsten", "shale"};
    block["loads"] = {"uniaxial", "biaxial"};
    jobs_a_pattern = 10;
  }
  block["patterns"] = {{"orthogonal", fmt::format("1-{}", std::max<std::uint64_t>(1, options.jobs / jobs_a_pattern))}};
  std::ofstream(file) << nlohmann::json{{"name", "throughput"}, {"seed", 7}, {"jobs", {block}}};
  return file;
}

double first_claim_s(const Options& options) {
  const auto began = Steady::now();
  Coordinator coordinator(options);
  Options one = options;
  const auto key = wire::load_or_make_key(one.folder, "worker-0");
  auto client = wire::Client::connect(wire::read_endpoint(one.folder)->endpoint, one.folder, *key);
  (void)client->ask(wire::Hello{"node-0", fmt::format("restart-{}", ::getpid()), 1, 1u << 30, build_info().build_id, -1.0, {}}, 60.0);
  const auto reply = client->ask(wire::Next{{}, {}, {}, 1, -1.0}, 60.0);
  const double took_s = since(began);
  const auto* jobs = reply ? std::get_if<wire::Jobs>(&*reply) : nullptr;
  if (!jobs || jobs->assignments.empty()) throw std::runtime_error("no job after a restart");
  return took_s;
}

using Rows = std::vector<std::vector<std::string>>;

void measure_farm(const Options& options, Rows& rows) {
  const auto add = [&](std::string what, std::string measured, std::string wanted) {
    rows.push_back({std::move(what), std::move(measured), std::move(wanted)});
  };
  std::uint64_t done = 0;
  {
    Coordinator coordinator(options);
    const Timed submitted =
        timed({beside("fracfarm"), "submit", write_campaign(options), "--farm", options.folder}, options.folder / "submit.out");
    if (submitted.status != 0) throw std::runtime_error("submit: " + submitted.output);
    add(fmt::format("submit of {} jobs", options.jobs), fmt::format("{:.2f} s", submitted.seconds), "<= 15 s");
    for (const int batch : {1, 8}) {
      const double cpu_before_s = coordinator.cpu_s();
      const Rate rate = measure(options, batch);
      const double coordinator_us = 1e6 * (coordinator.cpu_s() - cpu_before_s) / static_cast<double>(std::max<std::uint64_t>(1, rate.done));
      if (rate.done == 0) throw std::runtime_error("no worker got a job done");
      done += rate.done;
      add(fmt::format("durable jobs/s, {} workers, batch {}", options.workers, batch), fmt::format("{:.0f}", rate.jobs_per_s),
          batch == 1 ? ">= 5000" : ">= 20000");
      add(fmt::format("claim p50, p99 at batch {}", batch), fmt::format("{:.1f}, {:.1f} ms", rate.p50_ms, rate.p99_ms), "p99 <= 50 ms");
      add(fmt::format("processor time a job at batch {}", batch),
          fmt::format("coordinator {:.0f} us, workers {:.0f} us", coordinator_us, rate.worker_us), "");
    }
    std::vector<double> seconds;
    for (int n = 0; n < 9; ++n)
      seconds.push_back(timed({beside("fracfarm"), "status", "--json", "--farm", options.folder}, options.folder / "status.out").seconds);
    std::sort(seconds.begin(), seconds.end());
    add("status --json, the program as a whole", fmt::format("{:.0f} ms (median of 9)", 1e3 * seconds[4]), "<= 50 ms");
    add("coordinator's peak memory", fmt::format("{:.0f} MB", coordinator.peak_mb()), "<= 150 MB");
    coordinator.end(SIGKILL);
  }
  add("restart after SIGKILL to first claim", fmt::format("{:.2f} s", first_claim_s(options)), "<= 2 s");
  const auto bytes = static_cast<double>(fs::file_size(options.folder / "ledger" / "ledger.db"));
  add(fmt::format("ledger, {} jobs done", done),
      fmt::format("{:.0f} MB, {:.0f} B a job done, {:.1f} B a job submitted", bytes / 1e6, bytes / static_cast<double>(done),
                  bytes / static_cast<double>(options.jobs)),
      "<= 300 B");
}

// --- others ---

void measure_others(const Options& options, Rows& rows) {
  const fs::path out = options.folder / "others.out";
  constexpr int jobs = 3000;
  const Timed parallel =
      timed({"parallel", "-j", std::to_string(options.workers), "--joblog", options.folder / "joblog", "true", ":::", "1"}, out);
  if (parallel.status == 0) {
    const Timed run = timed(
        {"sh", "-c", fmt::format("seq {} | parallel -j {} --joblog {} true", jobs, options.workers, (options.folder / "joblog2").string())},
        out);
    rows.push_back({"GNU parallel, jobs/s (true, --joblog)", fmt::format("{:.0f}", jobs / run.seconds), ""});
  } else {
    rows.push_back({"GNU parallel", "not installed", ""});
  }
  const std::string script = fmt::format(
      "import time\nfrom distributed import Client, LocalCluster\nif __name__ == '__main__':\n"
      "  c = Client(LocalCluster(n_workers=2, threads_per_worker={}, dashboard_address=None))\n  f = lambda x: x\n  c.gather(c.map(f, "
      "range(100)))\n"
      "  t = time.time()\n  c.gather(c.map(f, range(1000, {})))\n  print(({} - 1000) / (time.time() - t))\n  c.close()\n",
      options.workers / 2, 21000, 21000);
  std::ofstream(options.folder / "dask_run.py") << script;
  Timed dask;
  for (const char* python : {"python3", "/usr/bin/python3"})  // Debian's own where another comes first
    if (dask = timed({python, options.folder / "dask_run.py"}, out); dask.status == 0) break;
  std::string last = dask.output.substr(0, dask.output.find('\n'));
  if (dask.status == 0)
    rows.push_back({"Dask distributed, jobs/s (not durable)", last.substr(0, last.find('.')), ""});
  else
    rows.push_back({"Dask distributed", "not installed", ""});
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  options.folder = fs::temp_directory_path() / fmt::format("fracfarm-throughput-{}", ::getpid());
  bool keep = false, alone = false;
  CLI::App app{"Measures a farm's bookkeeping on this machine, and prints it as a table.", "fracfarm-farm-throughput"};
  app.add_option("--folder", options.folder, "a new folder, on the disk that is to be measured");
  app.add_option("--jobs", options.jobs, "jobs submitted")->check(CLI::Range(10, 2'090'000))->capture_default_str();
  app.add_option("--workers", options.workers, "simulated workers, a process each")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--seconds", options.seconds, "measured for each batch size")->check(CLI::Range(0.1, 3600.0))->capture_default_str();
  app.add_option("--method", options.method, "of the jobs: drill, or phase_field, whose scenes are longer")->capture_default_str();
  app.add_flag("--keep", keep, "leave the farm's folder");
  app.add_flag("--alone", alone, "without GNU parallel and Dask");
  CLI11_PARSE(app, argc, argv);
  ::signal(SIGPIPE, SIG_IGN);
  fs::create_directories(options.folder / "log");
  Rows rows{{"what", "measured", "wanted"}};
  int status = 0;
  try {
    measure_farm(options, rows);
    if (!alone) measure_others(options, rows);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    status = 1;
  }
  fmt::print("{}", table_text(rows));
  std::error_code none;
  if (!keep) fs::remove_all(options.folder, none);
  return status;
}
