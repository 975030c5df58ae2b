#include "common/wire/socket.hpp"

#include <catch2/catch.hpp>
#include <optional>
#include <thread>
#include <zmq.hpp>

#include "common/base/clock.hpp"
#include "common/wire/codec.hpp"
#include "common/wire/endpoint.hpp"
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
  Client client(const std::string& name) { return std::move(Client::connect("", path, load_or_make_key(path, name).value()).value()); }
  // The next message, waiting long enough for a slow machine.
  std::optional<Incoming> next(double timeout_s = 10.0) {
    auto all = server->receive(1, timeout_s);
    return all.empty() ? std::nullopt : std::optional(all.front());
  }
};

Reply wait_for(Client& client) {
  for (int i = 0; i < 100; ++i)
    if (auto reply = client.poll(0.1).value()) return *reply;
  FAIL("no reply");
  return ByeReply{};
}

}  // namespace

TEST_CASE("a request reaches the server under the name of its key, and the reply comes back") {
  Farm farm;
  Client client = farm.client("worker-a-0");
  REQUIRE(client.post(Ask{"status", "{}"}).has_value());
  const auto incoming = farm.next();
  REQUIRE(incoming);
  CHECK(incoming->peer == "worker-a-0");
  const auto request = decode_request(incoming->bytes);
  CHECK(std::get<Ask>(request->request).verb == "status");
  CHECK(farm.server->send(incoming->route, encode(ReplyEnvelope{request->request_id, Answer{0, "ok"}})));
  CHECK(std::get<Answer>(wait_for(client)).body == "ok");
  CHECK(farm.server->healthy());
}

TEST_CASE("a key that is not in the farm's folder never reaches the server") {
  Farm farm;
  const TempFarm elsewhere;
  const KeyPair stranger = load_or_make_key(elsewhere.path, "worker-a-0").value();
  Client client = std::move(Client::connect("", farm.path, stranger).value());
  REQUIRE(client.post(Ask{"status", "{}"}).has_value());
  CHECK_FALSE(farm.next(1.0));
  CHECK(farm.server->counts().unknown_keys >= 1);
  CHECK(farm.server->healthy());
}

TEST_CASE("a key that was allowed after the server started is let in, a revoked one is not let in again") {
  Farm farm;
  Client late = farm.client("late");
  REQUIRE(late.post(Bye{}).has_value());
  REQUIRE(farm.next());
  const KeyPair pair = load_or_make_key(farm.path, "late").value();
  std::filesystem::remove(farm.path / "keys/allowed/late.pub");
  Client again = std::move(Client::connect("", farm.path, pair).value());
  REQUIRE(again.post(Bye{}).has_value());
  const auto incoming = farm.next(1.0);
  CHECK_FALSE(incoming);
}

TEST_CASE("a client that speaks no CURVE is not heard") {
  Farm farm;
  zmq::context_t context;
  zmq::socket_t plain(context, zmq::socket_type::dealer);
  plain.set(zmq::sockopt::linger, 0);
  plain.connect(farm.server->endpoint());
  plain.send(zmq::str_buffer("hello"), zmq::send_flags::dontwait);
  CHECK_FALSE(farm.next(0.5));
}

TEST_CASE("a restarted server on another port gets the same request again") {
  Farm farm;
  Client client = farm.client("worker-a-0");
  REQUIRE(client.post(Beat{}).has_value());
  const auto lost = farm.next();
  REQUIRE(lost);
  const auto id = decode_request(lost->bytes)->request_id;
  farm.server.reset();
  farm.start();
  std::optional<Incoming> again;
  for (int i = 0; i < 100 && !again; ++i) {
    CHECK_FALSE(client.poll(0.05).value());
    again = farm.next(0.05);
  }
  REQUIRE(again);
  CHECK(decode_request(again->bytes)->request_id == id);
  CHECK(client.epoch() == 2);
  farm.server->send(again->route, encode(ReplyEnvelope{id, BeatReply{}}));
  CHECK(std::holds_alternative<BeatReply>(wait_for(client)));
}

TEST_CASE("a refusal comes back as BAD_REQUEST, even where the server could not read the request's id") {
  Farm farm;
  Client client = farm.client("worker-a-0");
  REQUIRE(client.post(Bye{}).has_value());
  const auto incoming = farm.next();
  REQUIRE(incoming);
  farm.server->send(incoming->route, encode(ReplyEnvelope{0, Refusal{"too old"}}));
  Result<std::optional<Reply>> reply = std::optional<Reply>();
  for (int i = 0; i < 100 && reply && !*reply; ++i) reply = client.poll(0.1);
  REQUIRE_FALSE(reply.has_value());
  CHECK(reply.error().fault == Fault::bad_request);
  CHECK(reply.error().message == "the coordinator refused: too old");
}

TEST_CASE("asking a farm where nobody answers ends with NODE_LOST, and a late reply is not taken for the next one") {
  Farm farm;
  Client client = farm.client("client");
  const auto nothing = client.ask(Ask{"status", "{}"}, 0.3);
  REQUIRE_FALSE(nothing.has_value());
  CHECK(nothing.error().fault == Fault::node_lost);
  const auto first = farm.next();
  REQUIRE(first);
  farm.server->send(first->route, encode(ReplyEnvelope{decode_request(first->bytes)->request_id, Answer{0, "late"}}));
  REQUIRE(client.post(Ask{"jobs", "{}"}).has_value());
  const auto second = farm.next();
  REQUIRE(second);
  farm.server->send(second->route, encode(ReplyEnvelope{decode_request(second->bytes)->request_id, Answer{0, "in time"}}));
  CHECK(std::get<Answer>(wait_for(client)).body == "in time");
}

TEST_CASE("sending to a peer that is gone fails at once instead of vanishing") {
  Farm farm;
  std::optional<Client> client(farm.client("worker-a-0"));
  REQUIRE(client->post(Bye{}).has_value());
  const auto incoming = farm.next();
  REQUIRE(incoming);
  client.reset();
  bool sent = true;
  for (int i = 0; i < 200 && sent; ++i) {
    sent = farm.server->send(incoming->route, "x");
    (void)farm.server->receive(1, 0.01);
  }
  CHECK_FALSE(sent);
  CHECK(farm.server->counts().unsendable == 1);
}

TEST_CASE("an endpoint file that no coordinator wrote is refused in words") {
  const TempFarm farm;
  CHECK(read_endpoint(farm.path).error().message.find("no coordinator has run") != std::string::npos);
  REQUIRE(write_endpoint(farm.path, {"tcp://127.0.0.1:5", 3, 99}).has_value());
  CHECK(read_endpoint(farm.path).value() == Endpoint{"tcp://127.0.0.1:5", 3, 99});
}
