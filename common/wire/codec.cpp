// One function that writes any table of fields.hpp and one that reads any table, straight from and to bytes: no tree is built of a
// message. What is read is walked over first: deep, wide, cut-off or foreign MessagePack is refused before anything is made of it.
#include "common/wire/codec.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "common/wire/fields.hpp"
#include "common/wire/msgpack.hpp"
#include "common/wire/text_guard.hpp"

namespace fracfarm::wire {
namespace {

using msgpack::Kind;

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
void write(std::string& bytes, const T& value, std::size_t limit) {
  if constexpr (std::is_same_v<T, std::string>) {
    const bool bounded = limit == text_limit || limit == name_limit;
    if (bounded && !is_clean(value, limit)) return msgpack::put_text(bytes, clean_text(value, limit));
    msgpack::put_text(bytes, value);
  } else if constexpr (std::is_enum_v<T>) {
    msgpack::put_text(bytes, enum_name(value));
  } else if constexpr (std::is_unsigned_v<T>) {
    msgpack::put_unsigned(bytes, value);
  } else if constexpr (std::is_integral_v<T>) {
    msgpack::put_signed(bytes, value);
  } else if constexpr (std::is_floating_point_v<T>) {
    msgpack::put_real(bytes, value);
  } else if constexpr (is_optional<T>) {
    if (!value) return msgpack::put_nil(bytes);
    write(bytes, *value, limit);
  } else if constexpr (is_vector<T>) {
    msgpack::put_list(bytes, value.size());
    for (const auto& element : value) write(bytes, element, usual_limit<typename T::value_type>);
  } else {
    constexpr auto table = fields(Of<T>{});
    msgpack::put_map(bytes, std::tuple_size_v<decltype(table)>);
    std::apply([&](const auto&... f) { ((msgpack::put_text(bytes, f.name), write(bytes, value.*f.member, f.limit)), ...); }, table);
  }
}

template <class Variant>
std::string encode_envelope(std::uint64_t id, const Variant& message) {
  std::string bytes;
  msgpack::put_map(bytes, 4);
  msgpack::put_text(bytes, "v");
  msgpack::put_signed(bytes, protocol_version);
  msgpack::put_text(bytes, "id");
  msgpack::put_unsigned(bytes, id);
  msgpack::put_text(bytes, "kind");
  msgpack::put_text(bytes, kinds(Of<Variant>{})[message.index()]);
  msgpack::put_text(bytes, "body");
  std::visit([&](const auto& body) { write(bytes, body, 0); }, message);
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
bool read(msgpack::Reader& from, T& value, std::size_t limit, Wrong& wrong);

bool read_text(msgpack::Reader& from, std::string& value, std::size_t limit, Wrong& wrong) {
  const msgpack::Value it = from.take();
  if (it.kind != Kind::text) return wrong.is("is not a text");
  if (it.text.size() > limit) return wrong.is(fmt::format("is {} bytes long; the limit is {}", it.text.size(), limit));
  if (!is_utf8(it.text)) return wrong.is("is not UTF-8");
  value = it.text;
  return true;
}

template <class T>
bool read_integer(msgpack::Reader& from, T& value, Wrong& wrong) {
  const msgpack::Value it = from.take();
  if (it.kind != Kind::natural && it.kind != Kind::negative) return wrong.is("is not an integer");
  if (it.kind == Kind::natural) {
    if (it.natural > static_cast<std::uint64_t>(std::numeric_limits<T>::max()))
      return wrong.is(fmt::format("= {} is too large", it.natural));
    value = static_cast<T>(it.natural);
    return true;
  }
  if constexpr (std::is_unsigned_v<T>) return wrong.is(fmt::format("= {} is below 0", it.negative));
  if (it.negative < static_cast<std::int64_t>(std::numeric_limits<T>::min()))
    return wrong.is(fmt::format("= {} is too small", it.negative));
  value = static_cast<T>(it.negative);
  return true;
}

bool read_real(msgpack::Reader& from, double& value, Wrong& wrong) {
  const msgpack::Value it = from.take();
  value = it.kind == Kind::real       ? it.real
          : it.kind == Kind::natural  ? static_cast<double>(it.natural)
          : it.kind == Kind::negative ? static_cast<double>(it.negative)
                                      : NAN;
  return std::isfinite(value) || wrong.is("is not a finite number");
}

template <class T>
bool read_list(msgpack::Reader& from, std::vector<T>& value, std::size_t limit, Wrong& wrong) {
  const msgpack::Value head = from.take();
  if (head.kind != Kind::list) return wrong.is("is not a list");
  if (head.size > limit) return wrong.is(fmt::format("has {} elements; the limit is {}", head.size, limit));
  value.resize(head.size);
  for (std::size_t i = 0; i < value.size(); ++i)
    if (!read(from, value[i], usual_limit<T>, wrong)) return wrong.in(fmt::format("[{}]", i));
  return true;
}

// How one field is read, so that a key finds its field in a plain table.
template <class T>
struct FieldReader {
  std::string_view name;
  bool (*read)(msgpack::Reader&, T&, Wrong&);
};

template <class T, std::size_t I>
bool read_field(msgpack::Reader& from, T& value, Wrong& wrong) {
  constexpr auto f = std::get<I>(fields(Of<T>{}));
  return read(from, value.*f.member, f.limit, wrong) || wrong.in(f.name);
}

template <class T, std::size_t... I>
constexpr std::array<FieldReader<T>, sizeof...(I)> field_readers(std::index_sequence<I...>) {
  return {FieldReader<T>{std::get<I>(fields(Of<T>{})).name, &read_field<T, I>}...};
}

// Keys in any order; those in the order of the table are found at once.
template <class T>
bool read_struct(msgpack::Reader& from, T& value, Wrong& wrong) {
  constexpr std::size_t number = std::tuple_size_v<decltype(fields(Of<T>{}))>;
  static constexpr auto readers = field_readers<T>(std::make_index_sequence<number>{});
  const msgpack::Value head = from.take();
  if (head.kind != Kind::map) return wrong.is("is not a map");
  if (head.size > number) return wrong.is("has unknown keys");
  std::array<bool, number + 1> seen{};
  for (std::size_t i = 0; i < head.size; ++i) {
    const std::string_view key = from.take().text;
    std::size_t at = i;
    if (readers[at].name != key)
      for (at = 0; at < number && readers[at].name != key;) ++at;
    if (at == number) return wrong.is("has unknown keys");
    if (seen[at]) return wrong.is("is given twice"), wrong.in(readers[at].name);
    if (!readers[at].read(from, value, wrong)) return false;
    seen[at] = true;
  }
  for (std::size_t at = 0; at < number; ++at)
    if (!seen[at]) return wrong.is("is missing"), wrong.in(readers[at].name);
  return true;
}

template <class T>
bool read(msgpack::Reader& from, T& value, std::size_t limit, Wrong& wrong) {
  if constexpr (std::is_same_v<T, std::string>) {
    return read_text(from, value, limit, wrong);
  } else if constexpr (std::is_enum_v<T>) {
    const msgpack::Value it = from.take();
    const auto known = it.kind == Kind::text ? enum_by_name<T>(it.text) : std::nullopt;
    if (!known) return wrong.is("is no known name");
    value = *known;
    return true;
  } else if constexpr (std::is_integral_v<T>) {
    return read_integer(from, value, wrong);
  } else if constexpr (std::is_floating_point_v<T>) {
    return read_real(from, value, wrong);
  } else if constexpr (is_optional<T>) {
    if (!from.at_nil()) return read(from, value.emplace(), limit, wrong);
    return value.reset(), from.skip(), true;
  } else if constexpr (is_vector<T>) {
    return read_list(from, value, limit, wrong);
  } else {
    return read_struct(from, value, wrong);
  }
}

tl::unexpected<Error> refuse(std::string reason) { return fail(Fault::bad_request, std::move(reason)); }

template <class Variant, std::size_t I = 0>
bool read_kind(msgpack::Reader& body, std::string_view kind, Variant& message, Wrong& wrong) {
  if constexpr (I == std::variant_size_v<Variant>) {
    return wrong.is("is no known kind of message"), wrong.in("kind");
  } else {
    if (kind != kinds(Of<Variant>{})[I]) return read_kind<Variant, I + 1>(body, kind, message, wrong);
    return read(body, message.template emplace<I>(), 0, wrong) || wrong.in(kind);
  }
}

// Where the parts of an envelope begin, whatever their order.
struct Parts {
  std::optional<msgpack::Reader> version, id, kind, body;
};

std::optional<Parts> parts_of(std::string_view bytes) {
  if (!msgpack::well_formed(bytes, max_depth, max_values)) return std::nullopt;
  msgpack::Reader reader(bytes);
  const msgpack::Value head = reader.take();
  if (head.kind != Kind::map) return std::nullopt;
  Parts parts;
  for (std::size_t i = 0; i < head.size; ++i) {
    const std::string_view key = reader.take().text;
    if (key == "v") parts.version = reader;
    if (key == "id") parts.id = reader;
    if (key == "kind") parts.kind = reader;
    if (key == "body") parts.body = reader;
    reader.skip();
  }
  return parts;
}

template <class Envelope, class Variant>
Result<Envelope> decode_envelope(std::string_view bytes, Variant Envelope::*message) {
  if (bytes.size() > max_message_bytes) return refuse(fmt::format("message of {} bytes; the limit is {}", bytes.size(), max_message_bytes));
  std::optional<Parts> parts = parts_of(bytes);
  if (!parts) return refuse("not a message of this farm: no MessagePack map within the limits");
  Wrong wrong;
  int version = 0;
  if (!parts->version || !read(*parts->version, version, 0, wrong)) return refuse("not a message of this farm: no protocol version");
  if (version != protocol_version)
    return refuse(fmt::format("protocol version {} is not spoken here; this build speaks {}: install the same release on both sides",
                              version, protocol_version));
  Envelope envelope;
  std::string kind;
  if (!parts->id || !read(*parts->id, envelope.request_id, 0, wrong)) return refuse("message id is missing or no integer");
  if (!parts->kind || !read(*parts->kind, kind, name_limit, wrong)) return refuse("message kind is missing or no text");
  if (!parts->body) return refuse("message body is missing");
  if (!read_kind(*parts->body, kind, envelope.*message, wrong)) return refuse(fmt::format("{} {}", wrong.where, wrong.what));
  return envelope;
}

}  // namespace

std::string encode(const RequestEnvelope& envelope) { return encode_envelope(envelope.request_id, envelope.request); }
std::string encode(const ReplyEnvelope& envelope) { return encode_envelope(envelope.request_id, envelope.reply); }
Result<RequestEnvelope> decode_request(std::string_view bytes) { return decode_envelope(bytes, &RequestEnvelope::request); }
Result<ReplyEnvelope> decode_reply(std::string_view bytes) { return decode_envelope(bytes, &ReplyEnvelope::reply); }

}  // namespace fracfarm::wire
