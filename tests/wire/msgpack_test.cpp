// The writer and the reader beside nlohmann's, which is another hand's.
#include "common/wire/msgpack.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/base/random.hpp"
#include "common/wire/codec.hpp"
#include "tests/wire/mutants.hpp"
#include "tests/wire/samples.hpp"

using namespace fracfarm;
using namespace fracfarm::wire;
using namespace fracfarm::wire::msgpack;
using nlohmann::json;

namespace {

std::string packed(const json& value) {
  const auto bytes = json::to_msgpack(value);
  return {bytes.begin(), bytes.end()};
}

template <class Put>
std::string put(Put write) {
  std::string bytes;
  write(bytes);
  return bytes;
}

// As bounded as messages are: lists and maps, counted, and no binary.
class Bounds final : public json::json_sax_t {
 public:
  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t size) override { return open(size); }
  bool key(string_t&) override { return count(); }
  bool end_object() override { return --depth_, true; }
  bool start_array(std::size_t size) override { return open(size); }
  bool end_array() override { return --depth_, true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  bool count() { return ++values_ <= 200; }
  bool open(std::size_t size) { return ++depth_ <= 5 && size <= 200 && count(); }
  std::size_t depth_ = 0, values_ = 0;
};

bool well_formed_to_others(const std::string& bytes) {
  Bounds bounds;
  return json::sax_parse(bytes.begin(), bytes.end(), &bounds, json::input_format_t::msgpack);
}

}  // namespace

TEST_CASE("Integers of every width are written and read as nlohmann writes them") {
  for (int bits = 0; bits < 64; ++bits)
    for (const std::int64_t off : {-1, 0, 1}) {
      const auto value = static_cast<std::int64_t>((std::uint64_t{1} << bits) + static_cast<std::uint64_t>(off));
      for (const std::int64_t it : {value, value == std::numeric_limits<std::int64_t>::min() ? value : -value}) {
        const std::string bytes = put([&](std::string& to) { put_signed(to, it); });
        CHECK(bytes == packed(it));
        const Value read = Reader(bytes).take();
        CHECK(read.kind == (it < 0 ? Kind::negative : Kind::natural));
        CHECK((it < 0 ? read.negative : static_cast<std::int64_t>(read.natural)) == it);
      }
    }
  const auto largest = std::numeric_limits<std::uint64_t>::max();
  CHECK(Reader(put([&](std::string& to) { put_unsigned(to, largest); })).take().natural == largest);
}

TEST_CASE("An integer in a wider form than it needs is the same integer") {
  CHECK(Reader("\xD1\x01\x00"
               "rest")
            .take()
            .kind == Kind::broken);  // the literal ends at its first zero
  CHECK(Reader(std::string("\xD1\x01\x00", 3)).take().natural == 256);
  CHECK(Reader(std::string("\xD0\x05", 2)).take().natural == 5);
  CHECK(Reader(std::string("\xCF\0\0\0\0\0\0\0\x07", 9)).take().natural == 7);
}

TEST_CASE("Numbers keep every bit, in four bytes where that is enough") {
  for (const double value :
       {0.0, -0.0, 1.5, 0.1, -1e300, 1e-310, 3.5e38, 4.25e-5, static_cast<double>(std::numeric_limits<float>::max())}) {
    const std::string bytes = put([&](std::string& to) { put_real(to, value); });
    CHECK(bytes == packed(value));
    const double read = Reader(bytes).take().real;
    CHECK(read == value);
    CHECK(std::signbit(read) == std::signbit(value));
  }
}

TEST_CASE("Heads of texts, lists and maps are written as nlohmann writes them, at every border of their widths") {
  for (const std::size_t size : {0u, 15u, 16u, 31u, 32u, 255u, 256u, 65535u, 65536u}) {
    const std::string text(size, 'x');
    const std::string bytes = put([&](std::string& to) { put_text(to, text); });
    CHECK(bytes == packed(text));
    CHECK(Reader(bytes).take().text == text);
    const std::string list = packed(std::vector<int>(size, 1));
    CHECK(list.starts_with(put([&](std::string& to) { put_list(to, size); })));
    CHECK(Reader(list).take().size == size);
    json map = json::object();
    for (std::size_t n = 0; n < size; ++n) map[std::to_string(n)] = 1;
    CHECK(packed(map).starts_with(put([&](std::string& to) { put_map(to, size); })));
    CHECK(Reader(packed(map)).take().size == size);
  }
}

TEST_CASE("A value is skipped with all that it holds") {
  const std::string bytes = packed(json{{"a", {1, {2, "x"}, {{"b", nullptr}}}}, {"c", 2.5}}) + '\x07';
  Reader reader(bytes);
  reader.skip();
  CHECK(reader.take().natural == 7);
  CHECK(reader.ended());
}

TEST_CASE("What is well formed is so for another reader too, of 20,000 messages with damage") {
  RandomStream random(2026, 7, 2);
  std::vector<std::string> seeds;
  for (const Request& request : sample_requests()) seeds.push_back(encode(RequestEnvelope{9, request}));
  for (const Reply& reply : sample_replies()) seeds.push_back(encode(ReplyEnvelope{9, reply}));
  int formed = 0, different = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string bytes = test::any_bytes(seeds, random);
    const bool ours = well_formed(bytes, 5, 200);
    formed += ours;
    different += ours != well_formed_to_others(bytes);
  }
  CHECK(different == 0);
  CHECK(formed > 1000);
  CHECK(formed < 19'000);
}

TEST_CASE("Depth and number of values are bounded, whatever a head promises") {
  CHECK(well_formed(std::string("\x91\x91\x90"), 3, 10));
  CHECK_FALSE(well_formed(std::string("\x91\x91\x90"), 2, 10));
  CHECK(well_formed(std::string("\x92\x01\x02"), 1, 3));
  CHECK_FALSE(well_formed(std::string("\x92\x01\x02"), 1, 2));
  CHECK_FALSE(well_formed(std::string("\xDF\xFF\xFF\xFF\xFF", 5), 8, 1000));
  CHECK_FALSE(well_formed("", 8, 1000));
}
