// A farm in memory for tests: a small campaign in a ledger, a reactor, and workers that are told what to say.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "common/base/hash.hpp"
#include "coordinator/queries.hpp"
#include "coordinator/reactor.hpp"

namespace fracfarm::test {

inline std::string campaign_text(int patterns, const std::string& budget = R"({"wall_clock": "1h", "attempts": 3})",
                                 const std::string& name = "test") {
  return fmt::format(R"({{"name": "{}", "seed": 7, "jobs": [{{"method": "phase_field", "materials": ["pbx"], "loads": ["uniaxial"],
    "patterns": {{"orthogonal": "1-{}"}}}}], "budget": {}}})",
                     name, patterns, budget);
}

inline const std::string build = "build-a";

// The digest of a record is whatever a test says; here one of the job's key.
inline std::string digest_of(const std::string& text) { return sha256_hex(text); }

struct Farm {
  Ledger ledger = Ledger::in_memory();
  Instant now{1000.0, 1.7e9};
  ReactorSettings settings{build, 5.0, 30.0, 512};
  std::unique_ptr<Reactor> reactor;
  std::uint64_t request_id = 1;

  explicit Farm(int patterns = 4, const std::string& budget = R"({"wall_clock": "1h", "attempts": 3})") {
    start();
    if (patterns > 0) submit(campaign_text(patterns, budget));
  }
  void start() { reactor = std::make_unique<Reactor>(ledger, settings, now); }

  nlohmann::json ask(const std::string& verb, const nlohmann::json& arguments, int* exit_code = nullptr) {
    const auto answer = std::get<wire::Answer>(tell("client", wire::Ask{verb, arguments.dump()}));
    if (exit_code) *exit_code = answer.exit_code;
    return nlohmann::json::parse(answer.body);
  }
  nlohmann::json submit(const std::string& text, int* exit_code = nullptr) {
    nlohmann::json answer = ask("submit", {{"campaign", text}}, exit_code);
    while (tick()) {
    }
    return answer;
  }
  bool tick(double after_s = 0.0) {
    now.monotonic_s += after_s;
    now.wall_s += after_s;
    ledger.begin();
    const bool more = reactor->tick(now);
    ledger.commit();
    return more;
  }
  // Time in steps that a serving coordinator would take.
  void pass(double seconds) {
    for (double left = seconds; left > 0.0; left -= 2.0) tick(std::min(left, 2.0));
  }
  wire::Reply tell(const std::string& peer, const wire::Request& request, std::uint64_t id = 0) {
    ledger.begin();
    wire::Reply reply = reactor->answer(peer, {id ? id : request_id++, request}, now);
    ledger.commit();
    return reply;
  }
  wire::Reply hello(const std::string& peer, const std::string& node, const std::string& instance = "i1",
                    std::vector<wire::HeldLease> held = {}, int slots = 4) {
    return tell(peer, wire::Hello{node, instance, slots, 1u << 30, build, -1.0, std::move(held)});
  }
  wire::Jobs next(const std::string& peer, wire::Next request) { return std::get<wire::Jobs>(tell(peer, request)); }
  wire::Jobs claim(const std::string& peer, int slots, double remaining_s = -1.0) { return next(peer, {{}, {}, {}, slots, remaining_s}); }
  wire::Assignment one(const std::string& peer) { return claim(peer, 1).assignments.at(0); }
  wire::Receipt complete(const std::string& peer, const wire::Completion& it) { return next(peer, {{it}, {}, {}, 0, -1.0}).receipts.at(0); }
  wire::Receipt fail_with(const std::string& peer, const wire::Assignment& it, Fault fault, const std::string& signature = "s") {
    return next(peer, {{}, {{it.lease, it.key, fault, "said the test", signature}}, {}, 0, -1.0}).receipts.at(0);
  }
  wire::BeatReply beat(const std::string& peer, const std::vector<wire::HeldLease>& held) {
    return std::get<wire::BeatReply>(tell(peer, wire::Beat{held}));
  }

  Job job(const std::string& key) { return job_by_key(ledger.reading(), key).value(); }
  Job job(std::uint64_t id) { return job_by_id(ledger.reading(), static_cast<std::int64_t>(id)).value(); }
};

inline wire::Completion result_of(const wire::Assignment& it, const std::string& bytes = "record") {
  return {it.lease, it.key, Verdict::failed, 4.5e-5, "through_crack", 6.9e6, 180, 0.1, 0.2, "shard-0.tar", 512, 1000, digest_of(bytes)};
}
inline wire::HeldLease held(const wire::Assignment& it, long long step = 10) { return {it.lease, it.key, step}; }

}  // namespace fracfarm::test
