// Peers that mean ill, and keys that change while a farm runs.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <optional>
#include <zmq.hpp>

#include "common/base/clock.hpp"
#include "common/wire/codec.hpp"
#include "common/wire/endpoint.hpp"
#include "common/wire/socket.hpp"
#include "tests/wire/temp_farm.hpp"

using namespace fracfarm;
using namespace fracfarm::wire;

namespace {

struct Farm : TempFarm {
  std::optional<Server> server;
  std::uint64_t epoch = 0;

  Farm() { start(); }
  void start() {
    server.emplace(std::move(Server::bind("tcp://127.0.0.1:*", path).value()));
    REQUIRE(write_endpoint(path, {server->endpoint(), ++epoch, 1}).has_value());
  }
  Client client(const KeyPair& pair) { return std::move(Client::connect("", path, pair).value()); }
  KeyPair key(const std::string& name) { return load_or_make_key(path, name).value(); }
  std::optional<Incoming> next(double timeout_s = 10.0) {
    auto all = server->receive(1, timeout_s);
    return all.empty() ? std::nullopt : std::optional(all.front());
  }
  // A request of this client comes through and its answer goes back.
  bool talks(Client& client, double patience_s = 10.0) {
    if (!client.post(Bye{})) return false;
    SystemClock clock;
    for (const double last_s = clock.monotonic_s() + patience_s; clock.monotonic_s() < last_s;) {
      for (const Incoming& it : server->receive(16, 0.02))
        server->send(it.route, encode(ReplyEnvelope{decode_request(it.bytes)->request_id, ByeReply{}}));
      if (const auto reply = client.poll(0.02); reply && *reply) return true;
    }
    return false;
  }
  void wait_for_revocation() { (void)server->receive(1, 0.6); }
};

zmq::socket_t raw_dealer(zmq::context_t& context, const Farm& farm, const KeyPair& own, const std::string& route) {
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::curve_publickey, own.public_key);
  socket.set(zmq::sockopt::curve_secretkey, own.secret_key);
  socket.set(zmq::sockopt::curve_serverkey, server_public_key(farm.path).value());
  if (!route.empty()) socket.set(zmq::sockopt::routing_id, route);
  socket.connect(farm.server->endpoint());
  return socket;
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

TEST_CASE("a key that is taken away has no say any more, though its connection lasts") {
  Farm farm;
  Client client = farm.client(farm.key("worker-a-0"));
  REQUIRE(farm.talks(client));
  std::filesystem::remove(farm.path / "keys/allowed/worker-a-0.pub");
  farm.wait_for_revocation();
  CHECK_FALSE(farm.talks(client, 1.0));
  CHECK(farm.server->counts().revoked_keys >= 1);
  Client other = farm.client(farm.key("worker-b-0"));
  CHECK(farm.talks(other));
}

TEST_CASE("a worker's key is replaced while the farm runs: the old one is out, the new one in, under the same name") {
  Farm farm;
  zmq::context_t context;
  const KeyPair old_pair = farm.key("worker-a-0");
  zmq::socket_t stolen = raw_dealer(context, farm, old_pair, "");
  stolen.send(zmq::buffer(encode(RequestEnvelope{1, Beat{}})), zmq::send_flags::none);
  REQUIRE(farm.next());
  std::filesystem::remove(farm.path / "keys/worker-a-0.key");
  std::filesystem::remove(farm.path / "keys/allowed/worker-a-0.pub");
  Client new_life = farm.client(farm.key("worker-a-0"));
  farm.wait_for_revocation();
  CHECK(farm.talks(new_life));
  stolen.send(zmq::buffer(encode(RequestEnvelope{2, Beat{}})), zmq::send_flags::none);
  CHECK_FALSE(farm.next(0.5));
  CHECK(farm.server->counts().revoked_keys >= 1);
}

TEST_CASE("a worker that runs on finds its new pair when the old one is replaced, and stays out where only its public half was taken") {
  Farm farm;
  Client client = farm.client(farm.key("worker-a-0"));
  REQUIRE(farm.talks(client));
  const auto old_pair = farm.key("worker-a-0");
  std::filesystem::remove(farm.path / "keys/worker-a-0.key");
  std::filesystem::remove(farm.path / "keys/allowed/worker-a-0.pub");
  farm.wait_for_revocation();
  CHECK(farm.talks(client, 20.0));
  CHECK(farm.key("worker-a-0").public_key != old_pair.public_key);
  std::filesystem::remove(farm.path / "keys/allowed/worker-a-0.pub");
  farm.wait_for_revocation();
  CHECK_FALSE(farm.talks(client, 5.0));
}

TEST_CASE("the coordinator's key is replaced between two starts, and clients that lived on find the new one") {
  Farm farm;
  Client client = farm.client(farm.key("worker-a-0"));
  REQUIRE(farm.talks(client));
  farm.server.reset();
  std::filesystem::remove(farm.path / "keys/server.key");
  std::filesystem::remove(farm.path / "keys/server.pub");
  farm.start();
  CHECK(farm.talks(client, 20.0));
}

TEST_CASE("a stolen routing id is an address and no name") {
  Farm farm;
  zmq::context_t context;
  const KeyPair thief = farm.key("thief"), victim = farm.key("victim");
  zmq::socket_t own = raw_dealer(context, farm, victim, "the-victim");
  own.send(zmq::buffer(encode(RequestEnvelope{1, Beat{}})), zmq::send_flags::none);
  const auto first = farm.next();
  REQUIRE(first);
  CHECK(first->peer == "victim");
  zmq::socket_t stolen = raw_dealer(context, farm, thief, "the-victim");  // while the victim is connected: not let in
  stolen.send(zmq::buffer(encode(RequestEnvelope{2, Beat{}})), zmq::send_flags::none);
  if (const auto second = farm.next(1.0)) CHECK(second->peer == "thief");
  REQUIRE(farm.server->send(first->route, encode(ReplyEnvelope{1, BeatReply{}})));
  zmq::pollitem_t item{own.handle(), 0, ZMQ_POLLIN, 0};
  CHECK(zmq::poll(&item, 1, std::chrono::seconds(10)) == 1);
  zmq::pollitem_t nothing{stolen.handle(), 0, ZMQ_POLLIN, 0};
  CHECK(zmq::poll(&nothing, 1, std::chrono::milliseconds(300)) == 0);
}

TEST_CASE("messages over the limit and in many frames are thrown away, and the next ones are heard") {
  Farm farm;
  zmq::context_t context;
  const KeyPair own = farm.key("worker-a-0");
  zmq::socket_t socket = raw_dealer(context, farm, own, "");
  socket.send(zmq::str_buffer("one"), zmq::send_flags::sndmore);
  socket.send(zmq::str_buffer("two"), zmq::send_flags::none);
  CHECK_FALSE(farm.next(1.0));
  CHECK(farm.server->counts().odd_frames == 1);
  socket.send(zmq::buffer(std::string(max_message_bytes + 1, 'x')), zmq::send_flags::none);
  CHECK_FALSE(farm.next(1.0));
  Client other = farm.client(farm.key("worker-b-0"));
  CHECK(farm.talks(other));
  CHECK(farm.server->healthy());
}

TEST_CASE("a peer that reads nothing holds up nobody") {
  Farm farm;
  zmq::context_t context;
  zmq::socket_t slow = raw_dealer(context, farm, farm.key("slow"), "");
  slow.send(zmq::buffer(encode(RequestEnvelope{1, Beat{}})), zmq::send_flags::none);
  const auto incoming = farm.next();
  REQUIRE(incoming);
  const std::string big(1u << 20, 'x');
  int unsent = 0;
  for (int i = 0; i < 4000 && unsent < 3; ++i) unsent += !farm.server->send(incoming->route, big);
  CHECK(unsent == 3);  // its queue is full: sending says no at once
  Client other = farm.client(farm.key("worker-b-0"));
  CHECK(farm.talks(other));
}

TEST_CASE("ten thousand connections that say nothing, or rubbish, keep no worker out") {
  Farm farm;
  Client worker = farm.client(farm.key("worker-a-0"));
  REQUIRE(farm.talks(worker));
  int connected = 0;
  std::vector<int> open;
  for (int i = 0; i < 10'000; ++i) {
    const int fd = tcp_connection(farm.server->endpoint());
    if (fd < 0) continue;
    ++connected;
    if (i % 3 == 0) (void)!::send(fd, "GET / HTTP/1.1\r\n\r\n", 18, MSG_NOSIGNAL);
    if (i % 20 == 0)
      open.push_back(fd);
    else
      ::close(fd);
    if (i % 100 == 0) (void)farm.server->receive(16, 0.0);
  }
  CHECK(connected > 9'900);
  CHECK(farm.talks(worker, 30.0));
  Client late = farm.client(farm.key("worker-b-0"));
  CHECK(farm.talks(late, 30.0));
  for (const int fd : open) ::close(fd);
  CHECK(farm.server->healthy());
}
