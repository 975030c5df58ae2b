#include "common/wire/codec.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/wire/samples.hpp"

using namespace fracfarm;
using namespace fracfarm::wire;
using nlohmann::json;

namespace {

std::string pack(const json& tree) {
  const auto bytes = json::to_msgpack(tree);
  return {bytes.begin(), bytes.end()};
}

json envelope_of(const Request& request) { return json::from_msgpack(encode(RequestEnvelope{3, request})); }

std::string refusal_of(const json& envelope) {
  const auto decoded = decode_request(pack(envelope));
  REQUIRE_FALSE(decoded.has_value());
  CHECK(decoded.error().fault == Fault::bad_request);
  return decoded.error().message;
}

}  // namespace

TEST_CASE("every kind of request reads back as it was written") {
  for (const Request& request : sample_requests()) {
    const std::string bytes = encode(RequestEnvelope{71, request});
    const auto decoded = decode_request(bytes);
    REQUIRE(decoded.has_value());
    CHECK(decoded->request_id == 71);
    CHECK(decoded->request.index() == request.index());
    CHECK(encode(*decoded) == bytes);
  }
}

TEST_CASE("every kind of reply reads back as it was written") {
  for (const Reply& reply : sample_replies()) {
    const std::string bytes = encode(ReplyEnvelope{72, reply});
    const auto decoded = decode_reply(bytes);
    REQUIRE(decoded.has_value());
    CHECK(decoded->reply.index() == reply.index());
    CHECK(encode(*decoded) == bytes);
  }
}

TEST_CASE("values survive the wire: large leases, absent times, fault and verdict names") {
  const auto next = std::get<Next>(decode_request(encode(RequestEnvelope{1, sample_requests()[1]}))->request);
  CHECK(next.completed[0].lease.counter == std::numeric_limits<std::uint64_t>::max());
  CHECK(next.completed[0].time_to_failure == 4.25e-5);
  CHECK_FALSE(next.completed[1].time_to_failure.has_value());
  CHECK(next.failed[0].fault == Fault::out_of_memory);
  CHECK(next.failed[0].message == "killed: \xC3\xA9");
}

TEST_CASE("an unknown protocol version is refused in words") {
  json envelope = envelope_of(Bye{});
  envelope["v"] = 9;
  CHECK(refusal_of(envelope).find("protocol version 9") != std::string::npos);
  CHECK(refusal_of(envelope).find("speaks 1") != std::string::npos);
}

TEST_CASE("a wrong value is named by its path") {
  json envelope = envelope_of(sample_requests()[1]);
  SECTION("missing key") {
    envelope["body"]["completed"][1]["lease"].erase("epoch");
    CHECK(refusal_of(envelope) == "next.completed[1].lease.epoch is missing");
  }
  SECTION("negative counter") {
    envelope["body"]["returned"][0]["counter"] = -4;
    CHECK(refusal_of(envelope) == "next.returned[0].counter = -4 is below 0");
  }
  SECTION("too large an integer") {
    envelope["body"]["free_slots"] = 1ull << 40;
    CHECK(refusal_of(envelope) == "next.free_slots = 1099511627776 is too large");
  }
  SECTION("unknown fault") {
    envelope["body"]["failed"][0]["fault"] = "GREMLIN";
    CHECK(refusal_of(envelope) == "next.failed[0].fault is no known name");
  }
  SECTION("not finite") {
    envelope["body"]["remaining_s"] = std::numeric_limits<double>::quiet_NaN();
    CHECK(refusal_of(envelope) == "next.remaining_s is not a finite number");
  }
  SECTION("a key nobody knows") {
    envelope["body"]["haste"] = 1;
    CHECK(refusal_of(envelope) == "next has unknown keys");
  }
  SECTION("a key nobody knows in place of one that belongs there") {
    envelope["body"].erase("free_slots");
    envelope["body"]["haste"] = 1;
    CHECK(refusal_of(envelope) == "next has unknown keys");
  }
  SECTION("over-long text") {
    envelope["body"]["completed"][0]["shard"] = std::string(300, 'x');
    CHECK(refusal_of(envelope) == "next.completed[0].shard is 300 bytes long; the limit is 256");
  }
  SECTION("text that is not UTF-8") {
    envelope["body"]["completed"][0]["shard"] = "\xC0\x80";
    CHECK(refusal_of(envelope) == "next.completed[0].shard is not UTF-8");
  }
}

TEST_CASE("keys come in any order, and none twice") {
  const Request next = sample_requests()[1];
  const auto sorted = decode_request(pack(envelope_of(next)));  // a tree of JSON sorts them
  REQUIRE(sorted.has_value());
  CHECK(encode(*sorted) == encode(RequestEnvelope{3, next}));
  std::string twice(
      "\x84\xA1v\x01\xA2id\x05\xA4kind\xA3"
      "bye\xA4"
      "body\x81\xA8returned\x91\x82\xA5"
      "epoch\x01\xA5"
      "epoch\x02");
  CHECK(decode_request(twice).error().message == "bye.returned[0].epoch is given twice");
}

TEST_CASE("a list beyond its limit is refused") {
  json envelope = envelope_of(Bye{});
  envelope["body"]["returned"] = json::array();
  for (int i = 0; i < 4097; ++i) envelope["body"]["returned"].push_back({{"epoch", 1}, {"counter", i}});
  CHECK(refusal_of(envelope) == "bye.returned has 4097 elements; the limit is 4096");
}

TEST_CASE("deep, wide, truncated and non-JSON MessagePack is refused without harm") {
  CHECK_FALSE(decode_request(std::string(4'000'000, '\x91')).has_value());           // four million arrays in each other
  CHECK_FALSE(decode_request(std::string("\xDD\xFF\xFF\xFF\xFF", 5)).has_value());   // a list said to have 2^32 elements
  CHECK_FALSE(decode_request(std::string("\xDB\xFF\xFF\xFF\xFFx", 6)).has_value());  // a text said to have 2^32 bytes
  CHECK_FALSE(decode_request(std::string("\xC7\x04\x01grim", 7)).has_value());       // an extension type
  CHECK_FALSE(decode_request("").has_value());
  CHECK_FALSE(decode_request(encode(RequestEnvelope{1, Bye{}}) + "x").has_value());  // something after the end
  std::string wide("\xDD\x00\x20\x00\x00", 5);
  wide += std::string(0x200000, '\x01');  // two million integers in 2 MB
  CHECK_FALSE(decode_request(wide).has_value());
}

TEST_CASE("a message over the size limit is refused by its size") {
  const auto decoded = decode_request(std::string(max_message_bytes + 1, 'x'));
  CHECK(decoded.error().message == "message of 8388609 bytes; the limit is 8388608");
}

TEST_CASE("sentences for people are cleaned and clipped, so that a solver's last words cannot stop the farm") {
  const Next next{{}, {{{1, 2}, "k", Fault::solver_crash, std::string(10'000, '\xFF') + "\x1B[2J", std::string(400, 's')}}, {}, 0, -1.0};
  const auto decoded = decode_request(encode(RequestEnvelope{1, next}));
  REQUIRE(decoded.has_value());
  const Failed failed = std::get<Next>(decoded->request).failed[0];
  CHECK(failed.message == std::string(4096, '?'));
  CHECK(failed.signature.size() == 256);
}

TEST_CASE("trace prints a message as JSON and says where it is none") {
  CHECK(json::parse(trace(encode(RequestEnvelope{5, Beat{}}))) ==
        json{{"v", 1}, {"id", 5}, {"kind", "beat"}, {"body", {{"held", json::array()}}}});
  CHECK(trace("\xC1") == "not MessagePack");
}
