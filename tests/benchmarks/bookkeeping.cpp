// Bookkeeping: what the coordinator does for 64 workers that each report a batch of results and claim the next, without the network:
// decode, decide, write, commit with every sync, encode. The time is of the processor, by job.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "common/base/hash.hpp"
#include "common/wire/codec.hpp"
#include "coordinator/reactor.hpp"

namespace fracfarm::benchmarks {
namespace {

constexpr int workers = 64;
constexpr Instant now{1000.0, 1.7e9};

struct Desk {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("fracfarm-bookkeeping-{}", ::getpid());
  Ledger ledger;
  Reactor reactor;
  std::uint64_t request_id = 0;
  std::vector<std::string> requests;  // of each worker, the next

  explicit Desk(int batch) : ledger(opened(folder)), reactor(ledger, {"build"}, now), requests(workers) {
    ledger.begin();
    const std::string campaign =
        R"({"campaign": "{\"name\": \"b\", \"seed\": 7, \"jobs\": [{\"method\": \"drill\", \"patterns\": {\"orthogonal\": \"1-9000000\"}}]}"})";
    (void)reactor.answer("client", {1, wire::Ask{"submit", campaign}}, now);
    for (int n = 0; n < workers; ++n)
      (void)reactor.answer(peer(n), {1, wire::Hello{peer(n), "i", batch, 1u << 30, "build", -1.0, {}}}, now);
    ledger.commit();
    request_id = 1;
    for (int n = 0; n < workers; ++n) ask(n, {{}, {}, {}, batch, -1.0});
  }
  ~Desk() { std::filesystem::remove_all(folder); }

  static Ledger opened(const std::filesystem::path& folder) {
    std::filesystem::remove_all(folder);
    return std::move(Ledger::open({folder}, true).value());
  }
  static std::string peer(int n) { return fmt::format("worker-{}", n); }
  void ask(int n, const wire::Next& next) {
    requests[static_cast<std::size_t>(n)] = wire::encode(wire::RequestEnvelope{request_id + 1, next});
  }

  std::vector<std::string> turn() {
    std::vector<wire::ReplyEnvelope> replies;
    ledger.begin();
    for (int n = 0; n < workers; ++n) {
      const auto request = wire::decode_request(requests[static_cast<std::size_t>(n)]);
      replies.push_back({request->request_id, reactor.answer(peer(n), *request, now)});
    }
    (void)reactor.tick(now);
    ledger.commit();
    std::vector<std::string> bytes;
    for (const wire::ReplyEnvelope& it : replies) bytes.push_back(wire::encode(it));
    ++request_id;
    return bytes;
  }
};

wire::Completion done(const wire::Assignment& it) {
  return {it.lease, it.key, Verdict::censored, std::nullopt, "horizon", 1e6, 10, 0.0, 0.0, "throughput.tar", 512, 300, sha256_hex(it.key)};
}

void turn(benchmark::State& state) {
  const int batch = static_cast<int>(state.range(0));
  Desk desk(batch);
  std::int64_t jobs = 0;
  for (auto _ : state) {
    const std::vector<std::string> replies = desk.turn();
    state.PauseTiming();
    for (int n = 0; n < workers; ++n) {
      const auto reply = wire::decode_reply(replies[static_cast<std::size_t>(n)]);
      wire::Next next{{}, {}, {}, batch, -1.0};
      for (const wire::Assignment& it : std::get<wire::Jobs>(reply->reply).assignments) next.completed.push_back(done(it));
      jobs += static_cast<std::int64_t>(next.completed.size());
      desk.ask(n, next);
    }
    state.ResumeTiming();
  }
  state.SetItemsProcessed(jobs);
}

BENCHMARK(turn)->Name("bookkeeping/turn")->Arg(1)->Arg(8)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fracfarm::benchmarks
