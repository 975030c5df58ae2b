// One table of fields a struct, one function that writes any table and one that reads any table. What is read is bounded first: a SAX pass
// refuses deep, wide or non-JSON MessagePack before anything is built from it.
#include "common/wire/codec.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <tuple>
#include <type_traits>

#include "common/wire/text_guard.hpp"

namespace fracfarm::wire {
namespace {

using nlohmann::json;

constexpr std::size_t max_depth = 8;
constexpr std::size_t max_values = 200'000;  // in one message: bounds the memory of the parsed tree

constexpr std::size_t name_limit = 256;   // bytes of a name, key or digest
constexpr std::size_t text_limit = 4096;  // of a sentence for people: clipped when written
constexpr std::size_t scene_limit = 1u << 20;
constexpr std::size_t body_limit = max_message_bytes - 4096;
constexpr std::size_t list_limit = 4096;  // elements

// --- tables ---

template <class Struct, class Value>
struct Field {
  const char* name;
  Value Struct::*member;
  std::size_t limit;  // bytes of a string, elements of a list
};

template <class Value>
constexpr std::size_t usual_limit = std::is_same_v<Value, std::string> ? name_limit : list_limit;

template <class Struct, class Value>
constexpr Field<Struct, Value> field(const char* name, Value Struct::*member, std::size_t limit = usual_limit<Value>) {
  return {name, member, limit};
}

template <class T>
using Of = std::type_identity<T>;

constexpr auto fields(Of<LeaseId>) { return std::tuple{field("epoch", &LeaseId::epoch), field("counter", &LeaseId::counter)}; }
constexpr auto fields(Of<HeldLease>) {
  return std::tuple{field("lease", &HeldLease::lease), field("key", &HeldLease::key), field("step", &HeldLease::step)};
}
constexpr auto fields(Of<Hello>) {
  return std::tuple{field("node", &Hello::node),         field("instance", &Hello::instance),
                    field("slots", &Hello::slots),       field("memory_bytes", &Hello::memory_bytes),
                    field("build_id", &Hello::build_id), field("remaining_s", &Hello::remaining_s),
                    field("held", &Hello::held)};
}
constexpr auto fields(Of<Welcome>) {
  return std::tuple{field("epoch", &Welcome::epoch), field("beat_interval_s", &Welcome::beat_interval_s),
                    field("lease_timeout_s", &Welcome::lease_timeout_s), field("rulings", &Welcome::rulings)};
}
constexpr auto fields(Of<Completion>) {
  return std::tuple{field("lease", &Completion::lease),
                    field("key", &Completion::key),
                    field("verdict", &Completion::verdict),
                    field("time_to_failure", &Completion::time_to_failure),
                    field("failure_rule", &Completion::failure_rule),
                    field("peak_stress", &Completion::peak_stress),
                    field("steps", &Completion::steps),
                    field("cpu_s", &Completion::cpu_s),
                    field("wall_s", &Completion::wall_s),
                    field("shard", &Completion::shard),
                    field("offset", &Completion::offset),
                    field("length", &Completion::length),
                    field("sha256", &Completion::sha256)};
}
constexpr auto fields(Of<Failed>) {
  return std::tuple{field("lease", &Failed::lease), field("key", &Failed::key), field("fault", &Failed::fault),
                    field("message", &Failed::message, text_limit), field("signature", &Failed::signature)};
}
constexpr auto fields(Of<Next>) {
  return std::tuple{field("completed", &Next::completed), field("failed", &Next::failed), field("returned", &Next::returned),
                    field("free_slots", &Next::free_slots), field("remaining_s", &Next::remaining_s)};
}
constexpr auto fields(Of<Assignment>) {
  return std::tuple{field("lease", &Assignment::lease),
                    field("key", &Assignment::key),
                    field("job", &Assignment::job),
                    field("attempt", &Assignment::attempt),
                    field("scene", &Assignment::scene, scene_limit),
                    field("wall_budget_s", &Assignment::wall_budget_s),
                    field("step_scale", &Assignment::step_scale),
                    field("store", &Assignment::store, text_limit)};
}
constexpr auto fields(Of<Jobs>) {
  return std::tuple{field("receipts", &Jobs::receipts, 2 * list_limit), field("assignments", &Jobs::assignments),
                    field("order", &Jobs::order), field("wait_s", &Jobs::wait_s)};
}
constexpr auto fields(Of<Beat>) { return std::tuple{field("held", &Beat::held)}; }
constexpr auto fields(Of<BeatReply>) { return std::tuple{field("rulings", &BeatReply::rulings), field("order", &BeatReply::order)}; }
constexpr auto fields(Of<Bye>) { return std::tuple{field("returned", &Bye::returned)}; }
constexpr auto fields(Of<ByeReply>) { return std::tuple{}; }
constexpr auto fields(Of<Ask>) { return std::tuple{field("verb", &Ask::verb), field("arguments", &Ask::arguments, body_limit)}; }
constexpr auto fields(Of<Answer>) { return std::tuple{field("exit_code", &Answer::exit_code), field("body", &Answer::body, body_limit)}; }
constexpr auto fields(Of<Refusal>) { return std::tuple{field("reason", &Refusal::reason, text_limit)}; }

// Names of the alternatives, in the order of the variants.
constexpr std::array<const char*, 5> request_kinds{"hello", "next", "beat", "bye", "ask"};
constexpr std::array<const char*, 6> reply_kinds{"welcome", "jobs", "beat_reply", "bye_reply", "answer", "refusal"};
static_assert(std::variant_size_v<Request> == request_kinds.size() && std::variant_size_v<Reply> == reply_kinds.size());
constexpr std::span<const char* const> kinds(Of<Request>) { return request_kinds; }
constexpr std::span<const char* const> kinds(Of<Reply>) { return reply_kinds; }

// Names of the values of small enums, in their order; faults and verdicts have tables of their own.
constexpr std::array<const char*, 2> ruling_names{"adopt", "abandon"};
constexpr std::array<const char*, 4> order_names{"none", "wait", "drain", "stop"};
constexpr std::array<const char*, 4> receipt_names{"accepted", "duplicate", "stale", "refused"};
constexpr std::span<const char* const> names(Of<Ruling>) { return ruling_names; }
constexpr std::span<const char* const> names(Of<Order>) { return order_names; }
constexpr std::span<const char* const> names(Of<Receipt>) { return receipt_names; }

template <class Enum>
std::string_view enum_name(Enum value) {
  if constexpr (std::is_same_v<Enum, Fault>)
    return fault_row(value).name;
  else if constexpr (std::is_same_v<Enum, Verdict>)
    return name_of(value);
  else
    return names(Of<Enum>{})[static_cast<std::size_t>(value)];
}

template <class Enum>
std::optional<Enum> enum_by_name(std::string_view name) {
  if constexpr (std::is_same_v<Enum, Fault>) {
    return fault_by_name(name);
  } else if constexpr (std::is_same_v<Enum, Verdict>) {
    return verdict_by_name(name);
  } else {
    const auto all = names(Of<Enum>{});
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i] == name) return static_cast<Enum>(i);
    return std::nullopt;
  }
}

template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

// --- writing ---

template <class T>
json write(const T& value, std::size_t limit) {
  if constexpr (std::is_same_v<T, std::string>) {
    return limit == text_limit || limit == name_limit ? clean_text(value, limit) : value;
  } else if constexpr (std::is_enum_v<T>) {
    return enum_name(value);
  } else if constexpr (std::is_arithmetic_v<T>) {
    return value;
  } else if constexpr (is_optional<T>) {
    return value ? write(*value, limit) : json(nullptr);
  } else if constexpr (is_vector<T>) {
    json list = json::array();
    for (const auto& element : value) list.push_back(write(element, usual_limit<std::decay_t<decltype(element)>>));
    return list;
  } else {
    json object = json::object();
    std::apply([&](const auto&... f) { ((object[f.name] = write(value.*f.member, f.limit)), ...); }, fields(Of<T>{}));
    return object;
  }
}

template <class Variant>
std::string encode_envelope(std::uint64_t id, const Variant& message) {
  const json envelope{{"v", protocol_version},
                      {"id", id},
                      {"kind", kinds(Of<Variant>{})[message.index()]},
                      {"body", std::visit([](const auto& body) { return write(body, 0); }, message)}};
  std::string bytes;
  json::to_msgpack(envelope, nlohmann::detail::output_adapter<char>(bytes));
  return bytes;
}

// --- reading: false fills `wrong` with what is wrong and, going up, where ---

struct Wrong {
  std::string where;
  std::string what;
  bool in(std::string_view part) {
    where = where.empty() || where.front() == '[' ? fmt::format("{}{}", part, where) : fmt::format("{}.{}", part, where);
    return false;
  }
  bool is(std::string text) {
    what = std::move(text);
    return false;
  }
};

template <class T>
bool read(const json& from, T& value, std::size_t limit, Wrong& wrong);

template <class T>
bool read_integer(const json& from, T& value, Wrong& wrong) {
  if (!from.is_number_integer()) return wrong.is("is not an integer");
  if (from.is_number_unsigned()) {
    const auto number = from.get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(std::numeric_limits<T>::max())) return wrong.is(fmt::format("= {} is too large", number));
    value = static_cast<T>(number);
    return true;
  }
  const auto number = from.get<std::int64_t>();  // below 0: larger ones were read as unsigned
  if constexpr (std::is_unsigned_v<T>) return wrong.is(fmt::format("= {} is below 0", number));
  if (number < static_cast<std::int64_t>(std::numeric_limits<T>::min())) return wrong.is(fmt::format("= {} is too small", number));
  value = static_cast<T>(number);
  return true;
}

template <class T>
bool read_list(const json& from, std::vector<T>& value, std::size_t limit, Wrong& wrong) {
  if (!from.is_array()) return wrong.is("is not a list");
  if (from.size() > limit) return wrong.is(fmt::format("has {} elements; the limit is {}", from.size(), limit));
  value.resize(from.size());
  for (std::size_t i = 0; i < value.size(); ++i)
    if (!read(from[i], value[i], usual_limit<T>, wrong)) return wrong.in(fmt::format("[{}]", i));
  return true;
}

template <class Struct, class Value>
bool read_field(const json& from, Struct& value, const Field<Struct, Value>& f, Wrong& wrong) {
  const auto found = from.find(f.name);
  if (found == from.end()) return wrong.is("is missing"), wrong.in(f.name);
  return read(*found, value.*f.member, f.limit, wrong) || wrong.in(f.name);
}

template <class T>
bool read_struct(const json& from, T& value, Wrong& wrong) {
  if (!from.is_object()) return wrong.is("is not a map");
  constexpr auto table = fields(Of<T>{});
  if (from.size() > std::tuple_size_v<decltype(table)>) return wrong.is("has unknown keys");
  return std::apply([&](const auto&... f) { return (read_field(from, value, f, wrong) && ...); }, table);
}

template <class T>
bool read(const json& from, T& value, std::size_t limit, Wrong& wrong) {
  if constexpr (std::is_same_v<T, std::string>) {
    if (!from.is_string()) return wrong.is("is not a text");
    const auto& text = from.get_ref<const std::string&>();
    if (text.size() > limit) return wrong.is(fmt::format("is {} bytes long; the limit is {}", text.size(), limit));
    if (!is_utf8(text)) return wrong.is("is not UTF-8");
    value = text;
    return true;
  } else if constexpr (std::is_enum_v<T>) {
    const auto known = from.is_string() ? enum_by_name<T>(from.get_ref<const std::string&>()) : std::nullopt;
    if (!known) return wrong.is("is no known name");
    value = *known;
    return true;
  } else if constexpr (std::is_integral_v<T>) {
    return read_integer(from, value, wrong);
  } else if constexpr (std::is_floating_point_v<T>) {
    if (!from.is_number() || !std::isfinite(from.get<double>())) return wrong.is("is not a finite number");
    value = from.get<double>();
    return true;
  } else if constexpr (is_optional<T>) {
    if (from.is_null()) return value.reset(), true;
    return read(from, value.emplace(), limit, wrong);
  } else if constexpr (is_vector<T>) {
    return read_list(from, value, limit, wrong);
  } else {
    return read_struct(from, value, wrong);
  }
}

// --- the guard: stops at the first value that no message of ours can have ---

class Guard final : public json::json_sax_t {
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
  bool end_object() override { return close(); }
  bool start_array(std::size_t size) override { return open(size); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  bool count() { return ++values_ <= max_values; }
  bool open(std::size_t size) { return ++depth_ <= max_depth && size <= max_values && count(); }
  bool close() { return --depth_, true; }
  std::size_t depth_ = 0;
  std::size_t values_ = 0;
};

std::optional<json> parse(std::string_view bytes) {
  Guard guard;
  if (!json::sax_parse(bytes.begin(), bytes.end(), &guard, json::input_format_t::msgpack)) return std::nullopt;
  json tree = json::from_msgpack(bytes.begin(), bytes.end(), true, false);
  if (tree.is_discarded()) return std::nullopt;
  return tree;
}

tl::unexpected<Error> refuse(std::string reason) { return fail(Fault::bad_request, std::move(reason)); }

template <class Variant, std::size_t I = 0>
bool read_kind(const json& envelope, std::string_view kind, Variant& message, Wrong& wrong) {
  if constexpr (I == std::variant_size_v<Variant>) {
    return wrong.is("is no known kind of message"), wrong.in("kind");
  } else {
    if (kind != kinds(Of<Variant>{})[I]) return read_kind<Variant, I + 1>(envelope, kind, message, wrong);
    return read(envelope["body"], message.template emplace<I>(), 0, wrong) || wrong.in(kind);
  }
}

template <class Envelope, class Variant>
Result<Envelope> decode_envelope(std::string_view bytes, Variant Envelope::*message) {
  if (bytes.size() > max_message_bytes) return refuse(fmt::format("message of {} bytes; the limit is {}", bytes.size(), max_message_bytes));
  const std::optional<json> tree = parse(bytes);
  if (!tree || !tree->is_object()) return refuse("not a message of this farm: no MessagePack map within the limits");
  Wrong wrong;
  int version = 0;
  const auto v = tree->find("v");
  if (v == tree->end() || !read(*v, version, 0, wrong)) return refuse("not a message of this farm: no protocol version");
  if (version != protocol_version)
    return refuse(fmt::format("protocol version {} is not spoken here; this build speaks {}: install the same release on both sides",
                              version, protocol_version));
  Envelope envelope;
  std::string kind;
  if (!tree->contains("id") || !read((*tree)["id"], envelope.request_id, 0, wrong)) return refuse("message id is missing or no integer");
  if (!tree->contains("kind") || !read((*tree)["kind"], kind, name_limit, wrong)) return refuse("message kind is missing or no text");
  if (!tree->contains("body")) return refuse("message body is missing");
  if (!read_kind(*tree, kind, envelope.*message, wrong)) return refuse(fmt::format("{} {}", wrong.where, wrong.what));
  return envelope;
}

}  // namespace

std::string encode(const RequestEnvelope& envelope) { return encode_envelope(envelope.request_id, envelope.request); }
std::string encode(const ReplyEnvelope& envelope) { return encode_envelope(envelope.request_id, envelope.reply); }
Result<RequestEnvelope> decode_request(std::string_view bytes) { return decode_envelope(bytes, &RequestEnvelope::request); }
Result<ReplyEnvelope> decode_reply(std::string_view bytes) { return decode_envelope(bytes, &ReplyEnvelope::reply); }

std::string trace(std::string_view bytes) {
  const std::optional<json> tree = bytes.size() <= max_message_bytes ? parse(bytes) : std::nullopt;
  return tree ? tree->dump(-1, ' ', false, json::error_handler_t::replace) : "not MessagePack";
}

}  // namespace fracfarm::wire
