#include "tests/simulation/coordinator_process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/wire/codec.hpp"
#include "tests/simulation/worker_process.hpp"

namespace fracfarm::simulation {
namespace {

constexpr std::size_t most_messages = 256;
const std::string file = "ledger.db";

std::string peer_name(int from) { return from == stranger ? "stranger" : from == person ? "client" : name_of_worker(from); }

}  // namespace

void CoordinatorProcess::open() {
  FaultDisk::use(world_.disk);
  ledger_.emplace(Ledger::over(Database::open(file)).value());
  if (ever_opened_) spoil_start(world_.settings.bug, ledger_->reading());
  reactor_ =
      std::make_unique<Reactor>(*ledger_, ReactorSettings{build, lease_timeout_s / 6.0, lease_timeout_s, 512, 0.1, 60.0}, world_.instant());
  epoch_ = reactor_->epoch();
  ever_opened_ = true;
  submitted_ = false;  // in this life
  changes_ = -1;
}

void CoordinatorProcess::start() {
  if (alive()) return;
  world_.disk.revive();
  ++life_;
  if (world_.fault(0.5)) {
    static constexpr Trouble troubles[]{Trouble::no_space,    Trouble::io_error, Trouble::short_write, Trouble::torn_page,
                                        Trouble::lost_writes, Trouble::killed,   Trouble::failed_sync};
    world_.disk.plan(static_cast<std::uint64_t>(world_.random.integer(0, 250)), troubles[world_.pick(std::size(troubles))]);
  }
  try {
    open();
    world_.trace(fmt::format("coordinator {}", epoch_));
  } catch (const LedgerError&) {
    return die(false);
  }
  hear({person, "",
        wire::encode(
            wire::RequestEnvelope{0, wire::Ask{"submit", nlohmann::json{{"campaign", campaign_text(world_.settings.patterns)}}.dump()}})});
}

void CoordinatorProcess::hear(Letter letter) {
  if (!alive()) return;  // nobody listens
  inbox_.push_back(std::move(letter));
  turn_soon(world_.random.uniform(0.0005, 0.01));
}

void CoordinatorProcess::turn_soon(double after_s) {
  world_.agenda.after(after_s, [this, life = life_, asked = ++turns_asked_] {
    if (life == life_ && asked == turns_asked_) turn();
  });
}

void CoordinatorProcess::stand_still(double seconds) { still_until_ = world_.agenda.now() + seconds; }

// A process that ends by itself closes its files; one that is killed does not get to it.
void CoordinatorProcess::die(bool with_its_power) {
  if (with_its_power)
    world_.disk.cut_power();
  else if (alive() && world_.chance(0.5))
    world_.disk.kill();
  reactor_.reset();
  try {
    ledger_.reset();
  } catch (const LedgerError&) {
  }
  inbox_.clear();
  ++life_;
  world_.trace("coordinator dies");
  world_.agenda.after(world_.random.uniform(0.3, 20.0), [this] { start(); });
}

Instant CoordinatorProcess::instant_for(int from) const {
  Instant now = world_.instant();
  if (world_.settings.bug == KnownBug::worker_clock_trusted && from >= 0) now.monotonic_s = world_.worker(from).own_clock_s();
  return now;
}

std::optional<CoordinatorProcess::Outgoing> CoordinatorProcess::answer(const Letter& letter) {
  const KnownBug bug = world_.settings.bug;
  const Result<wire::RequestEnvelope> request = wire::decode_request(letter.bytes);
  if (!request) return std::nullopt;
  const double now = world_.agenda.now();
  const std::string own = peer_name(letter.from),
                    peer = bug == KnownBug::identity_by_routing_id && letter.from != person ? letter.route : own;
  if (letter.from >= 0) world_.watch.asked(own, request->request);
  wire::RequestEnvelope taken = *request;
  spoil_request(bug, taken, *ledger_, fresh_id_);
  wire::Reply reply = reactor_->answer(peer, taken, instant_for(letter.from));
  spoil_reply(bug, reply);
  const auto* next = std::get_if<wire::Next>(&request->request);
  if (auto* jobs = std::get_if<wire::Jobs>(&reply); jobs && next && bug == KnownBug::planned_stop_counted)
    jobs->receipts.resize(next->completed.size() + next->failed.size());
  world_.tell([&] {
    static constexpr const char* requests[]{"HELLO", "NEXT", "BEAT", "BYE", "ASK"};
    static constexpr const char* replies[]{"WELCOME", "JOBS", "OK", "BYE", "ANSWER", "REFUSED"};
    return fmt::format("  {}: {} {} -> {}", own, requests[request->request.index()], request->request_id, replies[reply.index()]);
  });
  if (letter.from >= 0) world_.watch.answered(own, *request, reply, epoch_, now, ledger_->reading());
  if (letter.from == stranger) world_.watch.stranger_answered(reply);
  if (const auto* said = std::get_if<wire::Answer>(&reply); said && said->body.find("fracfarm.submit") != std::string::npos)
    submitted_ = true;
  return Outgoing{letter.from, *request, {request->request_id, std::move(reply)}};
}

void CoordinatorProcess::send(std::vector<Outgoing> replies) {
  for (const Outgoing& it : replies) {
    if (it.to < 0) continue;
    world_.watch.sent(name_of_worker(it.to), it.asked, it.reply.reply);
    world_.send_to_worker(it.to, wire::encode(it.reply));
  }
}

void CoordinatorProcess::turn() {
  if (const double left = still_until_ - world_.agenda.now(); left > 0.0) return turn_soon(left);
  std::vector<Outgoing> replies;
  const bool hasty = world_.settings.bug == KnownBug::acknowledge_before_commit;
  try {
    ledger_->begin();
    for (std::size_t n = 0; !inbox_.empty() && n < most_messages; ++n) {
      if (auto reply = answer(inbox_.front())) replies.push_back(std::move(*reply));
      inbox_.pop_front();
    }
    const bool more = reactor_->tick(world_.instant());
    if (hasty) send(replies);
    if (!replies.empty() && world_.fault(0.01)) return die(world_.chance(0.5));
    ledger_->commit();
    look();
    turn_soon(more ? 0.0 : world_.random.uniform(0.1, 3.0));
  } catch (const LedgerError&) {
    return die(false);  // what it does not answer is asked again
  }
  if (!replies.empty() && world_.fault(0.01)) return die(world_.chance(0.5));
  if (!hasty) send(std::move(replies));
}

// Nothing holds or breaks without a change.
void CoordinatorProcess::look() {
  Rows rows = ledger_->reading().query("SELECT total_changes()");
  const std::int64_t changes = rows.next() ? rows.integer(0) : 0;
  if (std::exchange(changes_, changes) == changes) return;
  world_.watch.look(ledger_->reading(), world_.agenda.now());
  world_.trace(world_.watch.state());
}

}  // namespace fracfarm::simulation
