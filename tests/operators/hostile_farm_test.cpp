// Peers that mean ill, against a real coordinator while real workers work: it serves on, gives no job away, takes no result from a
// stranger, and stays small. Keys that are taken away or replaced while their worker holds jobs.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <zmq.hpp>

#include "common/base/random.hpp"
#include "common/wire/codec.hpp"
#include "common/wire/endpoint.hpp"
#include "common/wire/keys.hpp"
#include "tests/system/farm_bench.hpp"
#include "tests/wire/samples.hpp"

using namespace fracfarm;
using namespace fracfarm::bench;

namespace {

namespace fs = std::filesystem;

// What a process holds now.
struct Weight {
  long resident_kb = 0;
  int descriptors = 0;
};
Weight weight_of(const Process& process) {
  Weight weight;
  const fs::path proc = fmt::format("/proc/{}", process.pid());
  std::ifstream status(proc / "status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) weight.resident_kb = std::stol(line.substr(6));
  weight.descriptors = static_cast<int>(std::distance(fs::directory_iterator(proc / "fd"), {}));
  return weight;
}

// A coordinator at work: a worker does drills all the while that a test lasts.
struct Siege {
  static constexpr int jobs = 240;
  FarmBench farm;
  std::optional<Process> coordinator, worker;
  Weight before;
  zmq::context_t context;

  Siege() {
    const auto file = farm.folder() / "drills.toml";
    std::ofstream(file) << "name = \"drills\"\nseed = 1\n[[jobs]]\nmethod = \"drill\"\npatterns = { orthogonal = \"1-" << jobs
                        << "\" }\nset = { \"drill.seconds\" = 0.02 }\n";
    REQUIRE(farm.verb({"submit", file.string()}).status == 0);
    coordinator.emplace(farm.coordinator({"--audit", "0"}));
    worker.emplace(farm.worker({"--slots", "1", "--once", "--node", "honest"}));
    REQUIRE(wait_until([&] { return farm.done() >= 3; }));
    before = weight_of(*coordinator);
  }
  wire::KeyPair key(const std::string& name) const { return wire::load_or_make_key(farm.farm(), name).value(); }
  std::string endpoint() const { return wire::read_endpoint(farm.farm()).value().endpoint; }
  zmq::socket_t dealer(const wire::KeyPair& own, const std::string& route = {}) {
    zmq::socket_t socket(context, zmq::socket_type::dealer);
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::sndtimeo, 2000);
    socket.set(zmq::sockopt::curve_publickey, own.public_key);
    socket.set(zmq::sockopt::curve_secretkey, own.secret_key);
    socket.set(zmq::sockopt::curve_serverkey, wire::server_public_key(farm.farm()).value());
    if (!route.empty()) socket.set(zmq::sockopt::routing_id, route);
    socket.connect(endpoint());
    return socket;
  }
  // Nothing where no reply comes.
  std::optional<wire::Reply> say(zmq::socket_t& socket, const std::string& bytes, int patience_ms = 30'000) {
    socket.set(zmq::sockopt::rcvtimeo, patience_ms);
    if (!socket.send(zmq::buffer(bytes), zmq::send_flags::none)) return std::nullopt;
    zmq::message_t message;
    if (!socket.recv(message)) return std::nullopt;
    const auto reply = wire::decode_reply(message.to_string_view());
    INFO("a reply that nobody can read: " << wire::trace(message.to_string_view()));
    REQUIRE(reply);
    return reply->reply;
  }
  std::optional<wire::Reply> say(zmq::socket_t& socket, const wire::Request& request, int patience_ms = 30'000) {
    return say(socket, wire::encode(wire::RequestEnvelope{++request_id_, request}), patience_ms);
  }
  wire::Hello hello() { return {"node-t", "start-1", 2, 1u << 30, farm.json({"status"})["build_id"].get<std::string>(), -1.0, {}}; }

  // Every job is done once, by the honest worker, and the coordinator holds no more than before.
  void end(long most_kb, int most_descriptors) {
    REQUIRE(coordinator->running());
    const Weight after = weight_of(*coordinator);
    CHECK(after.resident_kb - before.resident_kb < most_kb);
    CHECK(after.descriptors - before.descriptors < most_descriptors);
    WARN("the coordinator holds " << after.resident_kb / 1024 << " MB and " << after.descriptors << " files; before "
                                  << before.resident_kb / 1024 << " MB and " << before.descriptors);
    CHECK(worker->wait() == 0);
    farm.check_all_done(jobs);
    CHECK(farm.json({"status"})["faults"].empty());
    coordinator->signal(SIGTERM);
    CHECK(coordinator->wait() == 0);
    for (const auto& [job, count] : farm.starts()) CHECK(count == 1);
  }

 private:
  std::uint64_t request_id_ = 1u << 20;
};

std::string mutated(std::string bytes, RandomStream& random) {
  for (int edits = random.integer(1, 5); edits > 0 && !bytes.empty(); --edits) {
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
    if (random.integer(0, 3) == 0)
      bytes.resize(at);
    else
      bytes[at] = static_cast<char>(random.integer(0, 255));
  }
  return bytes;
}

int tcp_connection(const std::string& endpoint) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(endpoint.substr(endpoint.rfind(':') + 1))));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (fd >= 0 && ::connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) return ::close(fd), -1;
  return fd;
}

}  // namespace

TEST_CASE("a coordinator is sent damaged, oversized and old messages by a peer of its farm, and refuses each in words or closes the door") {
  Siege siege;
  zmq::socket_t peer = siege.dealer(siege.key("thief"));
  RandomStream random(5, 1, 1);
  std::vector<std::string> seeds;
  for (const wire::Request& request : wire::sample_requests()) seeds.push_back(wire::encode(wire::RequestEnvelope{9, request}));
  seeds.pop_back();  // what people ask may well be granted
  for (std::size_t n = 0; n < 3000; ++n) {
    const std::string bytes = mutated(seeds[n % seeds.size()], random);
    INFO("message " << n << ": " << wire::trace(bytes));
    REQUIRE(siege.say(peer, bytes));
  }
  std::string old = wire::encode(wire::RequestEnvelope{9, wire::Beat{}});
  const std::size_t version = old.find("\xa1v") + 2;
  old[version] = static_cast<char>(old[version] - 1);
  const auto refusal = siege.say(peer, old);
  REQUIRE(refusal);
  REQUIRE(std::holds_alternative<wire::Refusal>(*refusal));
  CHECK(std::get<wire::Refusal>(*refusal).reason.find("protocol version") != std::string::npos);
  for (int n = 0; n < 10; ++n) {
    zmq::socket_t loud = siege.dealer(siege.key("thief"));
    CHECK_FALSE(siege.say(loud, std::string(9u << 20, 'x'), 300));
  }
  siege.end(64 << 10, 40);
}

TEST_CASE("strangers, a stolen routing id and replayed results get no job and end none") {
  Siege siege;
  const TempFarm elsewhere;
  zmq::socket_t stranger = siege.dealer(wire::load_or_make_key(elsewhere.path, "worker-honest-0").value());
  CHECK_FALSE(siege.say(stranger, siege.hello(), 1000));

  zmq::socket_t victim = siege.dealer(siege.key("victim"), "the-victim");
  REQUIRE(siege.say(victim, siege.hello()));
  zmq::socket_t stolen = siege.dealer(siege.key("thief"), "the-victim");  // not let in while the victim is connected
  CHECK_FALSE(siege.say(stolen, siege.hello(), 1000));

  zmq::socket_t thief = siege.dealer(siege.key("thief"));
  REQUIRE(siege.say(thief, siege.hello()));
  wire::Next forged;
  wire::Bye bye;
  wire::Beat beat;
  const auto jobs = siege.farm.jobs();
  for (std::uint64_t n = 0; n < 40; ++n) {  // leases are easy to guess, keys are no secret
    const auto& job = jobs[n % jobs.size()];
    wire::Completion it;
    it.lease = {1, n + 1};
    it.key = job["key"];
    it.sha256 = std::string(64, 'a');
    it.shard = "shard-thief-0.tar";
    it.offset = 512, it.length = 1000;
    if (job["state"] == "done") it.sha256 = job["sha256"], it.shard = job["shard"], it.offset = job["offset"], it.length = job["length"];
    forged.completed.push_back(it);
    forged.failed.push_back({it.lease, it.key, Fault::bad_request, "forged", "forged"});
    forged.returned.push_back(it.lease);
    bye.returned.push_back(it.lease);
    beat.held.push_back({it.lease, it.key, 1});
  }
  const auto answer = siege.say(thief, forged);
  REQUIRE(answer);
  for (const wire::Receipt receipt : std::get<wire::Jobs>(*answer).receipts)
    CHECK((receipt == wire::Receipt::refused || receipt == wire::Receipt::stale));
  const auto rulings = siege.say(thief, beat);
  REQUIRE(rulings);
  for (const wire::Ruling ruling : std::get<wire::BeatReply>(*rulings).rulings) CHECK(ruling == wire::Ruling::abandon);
  CHECK(siege.say(thief, bye));
  CHECK(siege.say(victim, wire::Bye{}));
  siege.end(64 << 10, 40);
}

TEST_CASE("ten thousand connections, strangers' handshakes and a peer that never reads hold up nobody") {
  rlimit limit{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &limit) == 0);
  limit.rlim_cur = limit.rlim_max;
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &limit) == 0);
  const auto most_open = static_cast<std::size_t>(std::min<rlim_t>(3000, limit.rlim_cur / 2));
  Siege siege;
  zmq::socket_t deaf = siege.dealer(siege.key("deaf"));
  deaf.set(zmq::sockopt::rcvhwm, 1);
  deaf.set(zmq::sockopt::rcvbuf, 4096);
  int asked = 0;
  for (; asked < 5000; ++asked)
    if (!deaf.send(zmq::buffer(wire::encode(wire::RequestEnvelope{static_cast<std::uint64_t>(asked), wire::Ask{"status", "{}"}})),
                   zmq::send_flags::dontwait))
      break;
  CHECK(asked > 100);

  const TempFarm elsewhere;
  const wire::KeyPair foreign = wire::load_or_make_key(elsewhere.path, "worker-x").value();
  std::vector<zmq::socket_t> strangers;
  for (int n = 0; n < 100; ++n) strangers.push_back(siege.dealer(foreign));

  int connected = 0;
  Weight most;
  std::vector<int> open;
  for (int n = 0; n < 10'000; ++n) {
    const int fd = tcp_connection(siege.endpoint());
    if (fd < 0) continue;
    ++connected;
    if (n % 3 == 0) (void)!::send(fd, "GET / HTTP/1.1\r\n\r\n", 18, MSG_NOSIGNAL);
    if (open.size() < most_open)
      open.push_back(fd);
    else
      ::close(fd);
    if (n % 500 == 0) {
      const Weight now = weight_of(*siege.coordinator);
      most = {std::max(most.resident_kb, now.resident_kb), std::max(most.descriptors, now.descriptors)};
    }
  }
  CHECK(connected > 9'900);
  WARN(connected << " connections; at most " << most.descriptors << " files and " << most.resident_kb / 1024 << " MB");
  CHECK(siege.farm.verb({"status"}).status == 0);
  for (const int fd : open) ::close(fd);
  strangers.clear();
  deaf.close();
  REQUIRE(wait_until([&] { return weight_of(*siege.coordinator).descriptors < siege.before.descriptors + 40; }, 60.0));
  siege.end(256 << 10, 40);
}

namespace {

// Two workers with a slot each, and jobs of half a second.
struct TwoWorkers {
  static constexpr int jobs = 10;
  FarmBench farm;
  std::optional<Process> coordinator, a, b;

  explicit TwoWorkers(const char* lease_timeout) {
    const auto file = farm.folder() / "drills.toml";
    std::ofstream(file) << "name = \"drills\"\nseed = 1\n[[jobs]]\nmethod = \"drill\"\npatterns = { orthogonal = \"1-" << jobs
                        << "\" }\nset = { \"drill.seconds\" = 1.5 }\n";
    REQUIRE(farm.verb({"submit", file.string()}).status == 0);
    coordinator.emplace(farm.coordinator({"--lease-timeout", lease_timeout}));
    a.emplace(farm.worker({"--slots", "2", "--node", "a"}));
    REQUIRE(wait_until([&] { return farm.logged("\"started\""); }));
  }
  fs::path key(const std::string& name) const { return farm.farm() / "keys" / name; }
  std::map<std::string, int> done_by() {
    std::map<std::string, int> count;
    for (int job = 1; job <= jobs; ++job) ++count[farm.explain(job)["node"].get<std::string>()];
    return count;
  }
};

}  // namespace

TEST_CASE("a worker whose key is taken away while it holds jobs has no say any more, its jobs go to others, and nothing is lost") {
  TwoWorkers it("6");
  it.b.emplace(it.farm.worker({"--slots", "2", "--node", "b"}));
  fs::remove(it.key("allowed/worker-a-0.pub"));
  const int done_before = it.farm.done();
  REQUIRE(wait_until([&] { return it.farm.done() == it.jobs; }));
  CHECK(it.a->running());                                 // it works and asks; nobody hears it
  CHECK(it.done_by()["b"] >= it.jobs - done_before - 2);  // what was under way in the quarter of a second
  CHECK(it.farm.json({"status"})["faults"].value("NODE_LOST", 0) >= 1);
  it.a->signal(SIGTERM);
  CHECK(it.a->wait() == 3);
  // Let in again it says what it did: others were first, with the same results.
  std::ofstream(it.key("allowed/worker-a-0.pub")) << wire::load_key(it.farm.farm(), "worker-a-0").value().public_key << "\n";
  Process again = it.farm.worker({"--slots", "1", "--node", "a", "--once"});
  it.b->signal(SIGTERM);
  CHECK(it.b->wait() == 3);
  CHECK(again.wait() == 0);
  it.farm.check_all_done(it.jobs);
}

TEST_CASE("a worker whose key is replaced while it holds jobs goes on with them under the new one") {
  TwoWorkers it("120");  // the new pair is found sooner, however slow the machine
  const std::string before = wire::load_key(it.farm.farm(), "worker-a-0").value().public_key;
  fs::remove(it.key("worker-a-0.key"));
  fs::remove(it.key("allowed/worker-a-0.pub"));
  REQUIRE(wait_until([&] { return it.farm.done() == it.jobs; }));
  CHECK(wire::load_key(it.farm.farm(), "worker-a-0").value().public_key != before);
  for (const auto& [job, count] : it.farm.starts()) CHECK(count == 1);
  CHECK(it.farm.json({"status"})["faults"].empty());
  it.a->signal(SIGTERM);
  CHECK(it.a->wait() == 3);
  it.farm.check_all_done(it.jobs);
}
