// fracfarm-farm-utilisation: how much of many slots works, with the real reactor, the real worker session and the real ledger on a
// simulated clock and network. Two questions: 1 s jobs on 2,500 slots, and how much slot time allocations that end take away. Prints;
// asserts nothing.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <queue>

#include "common/base/hash.hpp"
#include "common/base/random.hpp"
#include "common/base/terminal.hpp"
#include "coordinator/reactor.hpp"
#include "worker/session.hpp"

using namespace fracfarm;

namespace {

struct Options {
  int workers = 100;
  int slots = 25;         // of each
  double seconds = 60.0;  // simulated, after the warm-up
  double warm_up_s = 20.0;
  double mean_s = 1.0;                       // of a job; times are log-normal
  double spread = 0.0;                       // of their logarithm
  double allocation_s = 0.0;                 // of a worker, 0: no end; a new one begins when it ends
  double latency_s = 0.002;                  // of a message, one way
  double commit_s = 0.005;                   // a turn of the coordinator
  double message_s = 40e-6, job_s = 110e-6;  // of the coordinator's one thread
  double keep_s = 0.02;                      // to judge a record and sync it
};

const std::string build = "simulated";

class Farm {
 public:
  explicit Farm(const Options& options) : options_(options), random_(1, 1, 1), reactor_(ledger_, {build, 5.0, 30.0, 512}, instant()) {
    const double budget_s = std::max(10.0, 20.0 * options.mean_s);
    const std::string campaign = fmt::format(
        R"({{"name": "simulated", "seed": 7, "jobs": [{{"method": "phase_field", "materials": ["pbx", "steel"],
    "loads": ["uniaxial"], "patterns": {{"orthogonal": "1-1000000"}}}}], "budget": {{"wall_clock": "{:.0f}s", "attempts": 3}}}})",
        budget_s);
    ledger_.begin();
    const auto answer = reactor_.answer("client", {1, wire::Ask{"submit", nlohmann::json{{"campaign", campaign}}.dump()}}, instant());
    ledger_.commit();
    if (std::get<wire::Answer>(answer).exit_code != 0) throw std::runtime_error(std::get<wire::Answer>(answer).body);
    for (int n = 0; n < options.workers; ++n) begin_worker(n);
    at(options_.commit_s, [this] { turn(); });
  }

  void run() {
    const double end_s = options_.warm_up_s + options_.seconds;
    while (!events_.empty() && events_.top().at <= end_s) {
      const Event event = events_.top();
      events_.pop();
      now_ = event.at;
      event.act();
    }
    now_ = end_s;
    for (auto& [id, worker] : workers_)
      for (const auto& [job, began] : worker->running) count_busy(began, now_, busy_s_);
  }

  double slot_seconds() const { return options_.seconds * options_.workers * options_.slots; }
  double busy_s() const { return busy_s_; }
  double cut_s() const { return cut_s_; }
  double given_back_s() const { return given_back_s_; }
  std::uint64_t done() const { return done_; }
  std::uint64_t cut() const { return cut_; }
  std::uint64_t counted_faults() {
    std::uint64_t n = 0;
    for (const auto& [fault, count] : fault_counts(ledger_.reading()))
      if (fault != "PLANNED_STOP") n += count;
    return n;
  }

 private:
  struct Event {
    double at;
    std::uint64_t order;
    std::function<void()> act;
    bool operator>(const Event& other) const { return std::pair(at, order) > std::pair(other.at, other.order); }
  };
  struct Worker {
    int id = 0;
    std::uint64_t start = 0;
    std::string peer;
    std::unique_ptr<worker::Session> session;
    double end_s = -1.0;
    double tick_s = -1.0;
    std::uint64_t request = 0;
    std::map<worker::JobId, double> running;  // since when
    std::map<worker::JobId, wire::Assignment> assignments;
  };
  struct Message {
    int worker;
    std::uint64_t start;
    wire::RequestEnvelope envelope;
  };

  Instant instant() const { return {1000.0 + now_, 1.7e9 + now_}; }
  void at(double when, std::function<void()> act) { events_.push({when, ++order_, std::move(act)}); }

  void count_busy(double from, double to, double& into) const { into += std::max(0.0, to - std::max(from, options_.warm_up_s)); }

  void begin_worker(int id) {
    auto worker = std::make_unique<Worker>();
    worker->id = id;
    worker->start = ++starts_;
    worker->peer = fmt::format("worker-{}", id);
    worker::SessionOptions session{.node = fmt::format("node-{}", id),
                                   .instance = fmt::format("start-{}", starts_),
                                   .build_id = build,
                                   .slots = options_.slots,
                                   .memory_bytes = 1ull << 36};
    if (options_.allocation_s > 0.0) {
      worker->end_s = now_ + options_.allocation_s * random_.uniform(0.5, 1.0);
      session.end_at = worker->end_s;
    }
    worker->session = std::make_unique<worker::Session>(session);
    workers_[id] = std::move(worker);
    feed(id, worker::Tick{});
  }

  void feed(int id, const worker::Event& event) {
    Worker& worker = *workers_[id];
    const std::uint64_t start = worker.start;
    for (const worker::Action& action : worker.session->step(event, now_)) {
      act(id, action);
      if (workers_[id]->start != start) return;  // it ended, another began
    }
    const double next_s = worker.session->next_tick(now_);
    if (worker.tick_s >= now_ && worker.tick_s <= next_s) return;
    worker.tick_s = next_s;
    at(next_s, [this, id, start, next_s] {
      if (workers_[id]->start == start && workers_[id]->tick_s == next_s) feed(id, worker::Tick{});
    });
  }

  void act(int id, const worker::Action& action) {
    Worker& worker = *workers_[id];
    const std::uint64_t start = worker.start;
    if (const auto* post = std::get_if<worker::Post>(&action)) {
      Message message{id, start, {++worker.request, post->request}};
      at(now_ + options_.latency_s, [this, message = std::move(message)] { waiting_.push_back(message); });
    } else if (const auto* job = std::get_if<worker::StartJob>(&action)) {
      worker.running[job->job] = now_;
      worker.assignments[job->job] = job->assignment;
      const double takes_s = options_.mean_s * std::exp(options_.spread * normal() - 0.5 * options_.spread * options_.spread);
      at(now_ + takes_s, [this, id, start, job = job->job, takes_s] { solved(id, start, job, takes_s); });
    } else if (const auto* stop = std::get_if<worker::StopJob>(&action)) {
      at(now_ + 0.1, [this, id, start, job = stop->job] { stopped(id, start, job); });
    } else if (std::holds_alternative<worker::Finish>(action)) {
      if (worker.end_s >= 0.0) count_busy(now_, worker.end_s, given_back_s_);
      // The scheduler starts the next allocation at once: what is given back early is somebody else's, and no longer this farm's.
      begin_worker(id);
    }
  }

  double normal() { return std::sqrt(-2.0 * std::log(1.0 - random_.uniform())) * std::cos(2.0 * 3.14159265358979 * random_.uniform()); }

  void solved(int id, std::uint64_t start, worker::JobId job, double takes_s) {
    Worker& worker = *workers_[id];
    const auto running = worker.running.find(job);
    if (worker.start != start || running == worker.running.end()) return;
    count_busy(running->second, now_, busy_s_);
    worker.running.erase(running);
    if (now_ > options_.warm_up_s) ++done_;
    feed(id, worker::JobSolved{job, takes_s});
    at(now_ + options_.keep_s, [this, id, start, job, takes_s] {
      if (workers_[id]->start != start) return;
      const wire::Assignment it = workers_[id]->assignments[job];
      workers_[id]->assignments.erase(job);
      feed(id, worker::JobKept{job,
                               {it.lease, it.key, Verdict::censored, std::nullopt, "horizon", 1e6, 10, takes_s, takes_s, "s.tar", 512, 300,
                                sha256_hex(it.key)}});
    });
  }

  void stopped(int id, std::uint64_t start, worker::JobId job) {
    Worker& worker = *workers_[id];
    const auto running = worker.running.find(job);
    if (worker.start != start || running == worker.running.end()) return;
    count_busy(running->second, now_, cut_s_);
    ++cut_;
    worker.running.erase(running);
    feed(id, worker::JobStopped{job});
  }

  // One transaction of the coordinator, which has one thread.
  void turn() {
    double busy_s = 0.0;
    std::vector<std::pair<Message, wire::Reply>> replies;
    ledger_.begin();
    for (std::size_t n = 0; !waiting_.empty() && n < 256; ++n) {
      Message message = std::move(waiting_.front());
      waiting_.pop_front();
      wire::Reply reply = reactor_.answer(fmt::format("worker-{}", message.worker), message.envelope, instant());
      busy_s += options_.message_s;
      if (const auto* jobs = std::get_if<wire::Jobs>(&reply)) busy_s += options_.job_s * static_cast<double>(jobs->assignments.size());
      replies.emplace_back(std::move(message), std::move(reply));
    }
    reactor_.tick(instant());
    ledger_.commit();
    (void)reactor_.take_events();
    (void)reactor_.take_notices();
    for (auto& [message, reply] : replies)
      at(now_ + busy_s + options_.commit_s + options_.latency_s,
         [this, id = message.worker, start = message.start, reply = std::move(reply)] {
           if (workers_[id]->start == start) feed(id, worker::ReplyCame{reply});
         });
    at(now_ + busy_s + options_.commit_s, [this] { turn(); });
  }

  Options options_;
  double now_ = 0.0;
  std::uint64_t order_ = 0, starts_ = 0;
  RandomStream random_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  Ledger ledger_ = Ledger::in_memory();
  Reactor reactor_;
  std::map<int, std::unique_ptr<Worker>> workers_;
  std::deque<Message> waiting_;
  double busy_s_ = 0.0, cut_s_ = 0.0, given_back_s_ = 0.0;
  std::uint64_t done_ = 0, cut_ = 0;
};

using Table = std::vector<std::vector<std::string>>;

void short_jobs(Options options, Table& rows) {
  Farm farm(options);
  farm.run();
  rows.push_back({fmt::format("{} slots, jobs of {:.3g} s", options.workers * options.slots, options.mean_s),
                  fmt::format("{:.2f} % of the slot time works, {} jobs", 100.0 * farm.busy_s() / farm.slot_seconds(), farm.done()),
                  ">= 99.5 %"});
}

void limits(Options options, Table& rows) {
  options.workers = 4;
  options.mean_s = 30.0;
  options.spread = 0.5;
  options.allocation_s = 4.0 * 3600.0;
  options.warm_up_s = 3600.0;
  options.seconds = 12.0 * 3600.0;
  Farm farm(options);
  farm.run();
  rows.push_back({fmt::format("{} slots, jobs of 30 s (log-normal, 0.5), allocations of 2 to 4 h", options.workers * options.slots),
                  fmt::format("{:.3f} % of the slot time in tries that a limit cut ({} of {}), {} counted as faults",
                              100.0 * farm.cut_s() / farm.slot_seconds(), farm.cut(), farm.done() + farm.cut(), farm.counted_faults()),
                  "<= 0.1 %"});
  const double idle_s = farm.slot_seconds() - farm.busy_s() - farm.cut_s();
  rows.push_back({"the same: idle, at the ends and between jobs", fmt::format("{:.3f} %", 100.0 * idle_s / farm.slot_seconds()), ""});
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  bool only_short = false;
  CLI::App app{"How much of many slots works: real reactor, session and ledger on a simulated clock.", "fracfarm-farm-utilisation"};
  app.add_option("--workers", options.workers, "workers")->capture_default_str();
  app.add_option("--slots", options.slots, "of each")->capture_default_str();
  app.add_option("--seconds", options.seconds, "simulated, after the warm-up")->capture_default_str();
  app.add_option("--mean", options.mean_s, "seconds of a job")->capture_default_str();
  app.add_flag("--short-jobs", only_short, "only the first question");
  CLI11_PARSE(app, argc, argv);
  Table rows{{"what", "measured", "wanted"}};
  short_jobs(options, rows);
  if (!only_short) limits(options, rows);
  fmt::print("{}", table_text(rows));
}
