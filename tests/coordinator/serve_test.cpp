#include "coordinator/serve.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "common/base/build_info.hpp"
#include "common/wire/endpoint.hpp"
#include "common/wire/socket.hpp"
#include "tests/coordinator/farm_fixture.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::test;

namespace {

// A coordinator that serves in a thread of its own.
struct Serving {
  std::filesystem::path farm;
  std::atomic<bool> stop{false};
  std::atomic<int> status{-1};
  std::thread thread;
  explicit Serving(const std::filesystem::path& path, bool until_done = false) : farm(path) {
    std::filesystem::create_directories(farm / "log");
    std::filesystem::remove(farm / "endpoint.json");
    thread = std::thread([this, until_done] {
      CoordinatorLog log(farm / "log", true);
      status = serve({farm, "tcp://127.0.0.1:*", until_done, 30.0}, stop, log);
    });
    while (status < 0 && !wire::read_endpoint(farm)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ~Serving() { end(); }
  int end() {
    stop = true;
    if (thread.joinable()) thread.join();
    return status;
  }
  wire::Client client(const std::string& name) {
    return wire::Client::connect(wire::read_endpoint(farm).value().endpoint, farm, wire::load_or_make_key(farm, name).value()).value();
  }
};

template <class T>
T reply_of(wire::Client& client, const wire::Request& request) {
  return std::get<T>(client.ask(request, 20.0).value());
}

const wire::Request empty_next = wire::Next{{}, {}, {}, 1, -1.0};
wire::Request hello() { return wire::Hello{"n1", "i1", 2, 1u << 30, build_info().build_id, -1.0, {}}; }
wire::Request submission(int patterns) { return wire::Ask{"submit", nlohmann::json{{"campaign", campaign_text(patterns)}}.dump()}; }

wire::Assignment first_job(wire::Client& worker) {
  for (;;) {
    wire::Jobs jobs = reply_of<wire::Jobs>(worker, empty_next);
    if (!jobs.assignments.empty()) return jobs.assignments[0];
  }
}

}  // namespace

TEST_CASE("A served farm takes a campaign, hands out a job, keeps its result over a restart") {
  TempFarm temp;
  wire::Assignment job;
  {
    Serving serving(temp.path);
    wire::Client client = serving.client("client"), worker = serving.client("worker-a");
    CHECK(reply_of<wire::Answer>(client, submission(1)).exit_code == 0);
    reply_of<wire::Welcome>(worker, hello());
    job = first_job(worker);
    CHECK(reply_of<wire::Jobs>(worker, wire::Next{{result_of(job)}, {}, {}, 0, -1.0}).receipts.at(0) == wire::Receipt::accepted);
    CHECK(serving.end() == exit_ok);
  }
  Ledger ledger = Ledger::open({temp.path}, false).value();
  CHECK(job_by_key(ledger.reading(), job.key)->outcome->sha256 == digest_of("record"));
}

TEST_CASE("It ends by itself when nothing is left, where it was asked to") {
  TempFarm temp;
  Serving serving(temp.path, true);
  {
    wire::Client client = serving.client("client"), worker = serving.client("worker-a");
    reply_of<wire::Welcome>(worker, hello());  // somebody is here: it does not end before the campaign comes
    reply_of<wire::Answer>(client, submission(1));
    const wire::Assignment job = first_job(worker);
    reply_of<wire::Jobs>(worker, wire::Next{{result_of(job)}, {}, {}, 0, -1.0});
    reply_of<wire::ByeReply>(worker, wire::Bye{});
  }
  serving.thread.join();
  CHECK(serving.status == exit_ok);
}

TEST_CASE("A second coordinator for the same farm refuses to serve") {
  TempFarm temp;
  Serving first(temp.path);
  CoordinatorLog log(temp.path / "log", true);
  std::atomic<bool> stop{true};
  ServeOptions options{temp.path};
  options.lock_patience_s = 0.05;
  CHECK(serve(options, stop, log) == exit_unreachable);
}

TEST_CASE("Unfinished jobs of another build keep a coordinator from serving") {
  TempFarm temp;
  {
    Ledger ledger = Ledger::open({temp.path}, true).value();
    ledger.begin();
    ledger.add_campaign("old", campaign_text(1), "another-build", 1, 0.0);
    ledger.set_build_id("another-build");
    ledger.commit();
  }
  std::filesystem::create_directories(temp.path / "log");
  CoordinatorLog log(temp.path / "log", true);
  std::atomic<bool> stop{true};
  CHECK(serve({temp.path}, stop, log) == exit_bad_input);
}
