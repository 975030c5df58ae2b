// libFuzzer target (option FRACFARM_FUZZ, clang): a reactor on a ledger in memory hears what a hostile farm may say, in any order: requests
// of every kind with fields that are known, near or nonsense, raw frames, copies, time that jumps, restarts. Whatever comes, replies can be
// read, counters equal a recount, no lease stands for two jobs, a result stays what it was, and only who was given a job ends it.
#include <fuzzer/FuzzedDataProvider.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/hash.hpp"
#include "common/wire/codec.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/reactor.hpp"

using namespace fracfarm;

namespace {

const std::string build = "build-a";
constexpr int most_turns = 400;
constexpr std::array<const char*, 4> peers{"worker-a", "worker-b", "client", "thief"};

void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

std::string campaign_text(int patterns, const std::string& act) {
  return R"({"name": "fuzz", "seed": 1, "jobs": [{"method": "drill", "patterns": {"orthogonal": "1-)" + std::to_string(patterns) +
         R"("}, "set": {"drill.act": ")" + act + R"("}}], "budget": {"wall_clock": "1min", "attempts": 3}})";
}

class HostileFarm {
 public:
  explicit HostileFarm(FuzzedDataProvider& data) : data_(data) {
    restart();
    hear("client", {next_id_++, wire::Ask{"submit", nlohmann::json{{"campaign", campaign_text(6, "sleep")}}.dump()}});
  }

  void turn() {
    switch (data_.ConsumeIntegralInRange(0, 15)) {
      case 0:
        return hear_raw(peer(), data_.ConsumeRandomLengthString(512));
      case 1:
        return restart();
      case 2:
      case 3:
        return pass(data_.PickValueInArray({0.0, 0.5, 3.0, 31.0, 70.0, 4000.0, -5.0, 1e9}));
      case 4:
        return hear(last_peer_, last_);  // a copy
      case 5:
      case 6:
        return say(ask());
      case 7:
      case 8:
        return say(hello());
      case 9:
        return say(beat());
      case 10:
        return say(wire::Bye{leases()});
      default:
        return say(next());
    }
  }

 private:
  void restart() { reactor_ = std::make_unique<Reactor>(ledger_, ReactorSettings{build, 5.0, 30.0, 512, 0.5}, now_); }

  void pass(double seconds) {
    now_.monotonic_s += std::max(0.0, seconds);
    now_.wall_s += seconds;
    ledger_.begin();
    (void)reactor_->tick(now_);
    ledger_.commit();
    look("");
  }

  void say(wire::Request request) {
    const std::uint64_t id = data_.ConsumeIntegralInRange(0, 7) ? next_id_++ : data_.ConsumeIntegral<std::uint64_t>();
    last_peer_ = peer();
    last_ = {id, std::move(request)};
    hear_raw(last_peer_, wire::encode(last_));
  }

  // As the switchboard does it.
  void hear_raw(const std::string& from, const std::string& bytes) {
    const Result<wire::RequestEnvelope> request = wire::decode_request(bytes);
    if (request) hear(from, *request);
  }

  void hear(const std::string& from, const wire::RequestEnvelope& request) {
    ledger_.begin();
    const wire::Reply reply = reactor_->answer(from, request, now_);
    ledger_.commit();
    const auto read = wire::decode_reply(wire::encode(wire::ReplyEnvelope{request.request_id, reply}));
    demand(read.has_value(), "a reply that its receiver cannot read");
    if (const auto* answer = std::get_if<wire::Answer>(&reply)) {
      const auto body = nlohmann::json::parse(answer->body, nullptr, false);
      demand(body.is_object() && body.contains("schema"), "an answer without a schema");
    }
    if (const auto* jobs = std::get_if<wire::Jobs>(&reply))
      for (const wire::Assignment& it : jobs->assignments) given_.insert({from, it.key}), seen_.push_back(it);
    look(from);
  }

  void look(const std::string& from) {
    Database& ledger = ledger_.reading();
    const auto counted = count_rows(ledger), recounted = recount_rows(ledger);
    demand(std::equal(counted.begin(), counted.end(), recounted.begin(), recounted.end(),
                      [](const CountRow& a, const CountRow& b) {
                        return a.campaign == b.campaign && a.state == b.state && a.verdict == b.verdict && a.job_class == b.job_class &&
                               a.n == b.n;
                      }),
           "counters that differ from a recount");
    JobFilter touched;
    touched.limit = 10'000;
    std::set<std::pair<std::uint64_t, std::uint64_t>> current;
    for (const Job& job : jobs_where(ledger, touched)) {
      demand(job.state != State::leased || current.insert({job.lease.epoch, job.lease.counter}).second, "a lease for two jobs");
      if (job.state != State::done) {
        demand(!done_.contains(job.key), "a job that was done and is not");
        continue;
      }
      if (!done_.emplace(job.key, job.outcome->peak_stress).second) {
        demand(done_[job.key] == job.outcome->peak_stress, "a result that changed");
        continue;
      }
      demand(given_.contains({from, job.key}), "a job that was done by somebody who was never given it");
    }
  }

  // --- what is said ---

  std::string peer() { return data_.PickValueInArray(peers); }
  std::string word() {
    return data_.ConsumeBool() ? data_.PickValueInArray({"n1", "n2", "i1", "i2", "", "worker-a"}) : data_.ConsumeRandomLengthString(40);
  }
  double real() {
    return data_.ConsumeBool() ? data_.PickValueInArray({-1.0, 0.0, 1e-300, 4.5e-5, 100.0, 1e300, HUGE_VAL, -HUGE_VAL, std::nan("")})
                               : data_.ConsumeFloatingPoint<double>();
  }
  const wire::Assignment* known() {
    return seen_.empty() ? nullptr : &seen_[data_.ConsumeIntegralInRange<std::size_t>(0, seen_.size() - 1)];
  }
  std::string key() {
    const wire::Assignment* it = known();
    if (it && data_.ConsumeIntegralInRange(0, 3)) return it->key;
    return data_.ConsumeBool() ? sha256_hex(word()) : data_.ConsumeRandomLengthString(70);
  }
  wire::LeaseId lease() {
    const wire::Assignment* it = known();
    if (it && data_.ConsumeIntegralInRange(0, 3)) return it->lease;
    return {data_.ConsumeIntegralInRange<std::uint64_t>(0, 4), data_.ConsumeIntegralInRange<std::uint64_t>(0, 20)};
  }
  std::vector<wire::LeaseId> leases() {
    std::vector<wire::LeaseId> list(data_.ConsumeIntegralInRange<std::size_t>(0, 3));
    for (wire::LeaseId& it : list) it = lease();
    return list;
  }
  std::vector<wire::HeldLease> held() {
    std::vector<wire::HeldLease> list(data_.ConsumeIntegralInRange<std::size_t>(0, 3));
    for (wire::HeldLease& it : list) {
      const wire::Assignment* assignment = known();
      it = assignment && data_.ConsumeBool() ? wire::HeldLease{assignment->lease, assignment->key, 5}
                                             : wire::HeldLease{lease(), key(), data_.ConsumeIntegral<long long>()};
    }
    return list;
  }
  wire::Hello hello() {
    wire::Hello it;
    it.node = word();
    it.instance = word();
    it.slots = data_.ConsumeBool() ? 2 : data_.ConsumeIntegral<int>();
    it.memory_bytes = data_.ConsumeBool() ? 1u << 30 : data_.ConsumeIntegral<std::uint64_t>();
    it.build_id = data_.ConsumeIntegralInRange(0, 5) ? build : word();
    it.remaining_s = real();
    it.held = held();
    return it;
  }
  wire::Completion completion() {
    wire::Completion it;
    const wire::Assignment* assignment = known();
    const bool honest = assignment && data_.ConsumeBool();
    it.lease = honest ? assignment->lease : lease();
    it.key = honest ? assignment->key : key();
    it.verdict = static_cast<Verdict>(data_.ConsumeIntegralInRange(0, 3));
    if (it.verdict == Verdict::failed || !data_.ConsumeIntegralInRange(0, 7)) it.time_to_failure = real();
    it.failure_rule = word();
    it.peak_stress = real();
    it.steps = data_.ConsumeBool() ? 180 : data_.ConsumeIntegral<long long>();
    it.cpu_s = real();
    it.wall_s = real();
    it.shard = data_.ConsumeBool() ? "shard-0.tar" : word();
    it.offset = data_.ConsumeBool() ? 512 : data_.ConsumeIntegral<std::uint64_t>();
    it.length = data_.ConsumeBool() ? 1000 : data_.ConsumeIntegral<std::uint64_t>();
    it.sha256 = data_.ConsumeBool() ? sha256_hex("record") : key();
    return it;
  }
  wire::Failed failed() {
    const wire::Assignment* it = known();
    const bool honest = it && data_.ConsumeBool();
    return {honest ? it->lease : lease(), honest ? it->key : key(),
            fault_table[data_.ConsumeIntegralInRange<std::size_t>(0, fault_table.size() - 1)].fault, word(), word()};
  }
  wire::Next next() {
    wire::Next it;
    it.completed.resize(data_.ConsumeIntegralInRange<std::size_t>(0, 3));
    for (wire::Completion& one : it.completed) one = completion();
    it.failed.resize(data_.ConsumeIntegralInRange<std::size_t>(0, 2));
    for (wire::Failed& one : it.failed) one = failed();
    it.returned = leases();
    it.free_slots = data_.ConsumeBool() ? 2 : data_.ConsumeIntegral<int>();
    it.remaining_s = data_.ConsumeBool() ? -1.0 : real();
    return it;
  }
  wire::Beat beat() { return {held()}; }

  // --- what people ask ---

  nlohmann::json value() {
    switch (data_.ConsumeIntegralInRange(0, 7)) {
      case 0:
        return data_.ConsumeIntegral<std::int64_t>();
      case 1:
        return data_.ConsumeBool();
      case 2:
        return real();
      case 3:
        return key();
      case 4:
        return data_.PickValueInArray({"READY", "HELD", "drill", "none", "fuzz", "SOLVER_CRASH", "1", "2", "worker-a", "n1"});
      case 5:
        return nlohmann::json::array({data_.ConsumeIntegralInRange<int>(-2, 9), word(), key(), nullptr});
      case 6:
        return campaign_text(data_.ConsumeIntegralInRange<int>(0, 9), data_.PickValueInArray({"sleep", "crash", "fly"}));
      default:
        return word();
    }
  }
  wire::Ask ask() {
    const auto rows = requests();
    const RequestRow& row = rows[data_.ConsumeIntegralInRange<std::size_t>(0, rows.size() - 1)];
    nlohmann::json arguments = nlohmann::json::object();
    for (const std::string_view name : row.arguments)
      if (data_.ConsumeBool()) arguments[std::string(name)] = value();
    wire::Ask it{std::string(row.verb), arguments.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
    if (!data_.ConsumeIntegralInRange(0, 9)) it.arguments = data_.ConsumeRandomLengthString(512);
    return it;
  }

  FuzzedDataProvider& data_;
  Ledger ledger_ = Ledger::in_memory();
  Instant now_{1000.0, 1.7e9};
  std::unique_ptr<Reactor> reactor_;
  std::uint64_t next_id_ = 1;
  std::string last_peer_ = "worker-a";
  wire::RequestEnvelope last_{1, wire::Beat{}};
  std::vector<wire::Assignment> seen_;
  std::set<std::pair<std::string, std::string>> given_;
  std::map<std::string, double> done_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  HostileFarm farm(data);
  for (int n = 0; n < most_turns && data.remaining_bytes() > 0; ++n) farm.turn();
  return 0;
}
