// The table of every message's fields: their names on the wire, in order, and what bounds them. The codec walks it both ways.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "common/wire/messages.hpp"

namespace fracfarm::wire {

inline constexpr std::size_t name_limit = 256;   // bytes of a name, key or digest
inline constexpr std::size_t text_limit = 4096;  // of a sentence for people: clipped when written
inline constexpr std::size_t scene_limit = 1u << 20;
inline constexpr std::size_t body_limit = max_message_bytes - 4096;
inline constexpr std::size_t list_limit = 4096;     // elements
inline constexpr std::size_t max_depth = 8;         // of lists and maps in one another
inline constexpr std::size_t max_values = 200'000;  // in one message, keys among them

template <class Struct, class Value>
struct Field {
  std::string_view name;
  Value Struct::*member;
  std::size_t limit;  // bytes of a string, elements of a list
};

template <class Value>
inline constexpr std::size_t usual_limit = std::is_same_v<Value, std::string> ? name_limit : list_limit;

template <class Struct, class Value>
constexpr Field<Struct, Value> field(std::string_view name, Value Struct::*member, std::size_t limit = usual_limit<Value>) {
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
inline constexpr std::array<std::string_view, 5> request_kinds{"hello", "next", "beat", "bye", "ask"};
inline constexpr std::array<std::string_view, 6> reply_kinds{"welcome", "jobs", "beat_reply", "bye_reply", "answer", "refusal"};
static_assert(std::variant_size_v<Request> == request_kinds.size() && std::variant_size_v<Reply> == reply_kinds.size());
constexpr std::span<const std::string_view> kinds(Of<Request>) { return request_kinds; }
constexpr std::span<const std::string_view> kinds(Of<Reply>) { return reply_kinds; }

// Names of the values of small enums, in their order; faults and verdicts have tables of their own.
inline constexpr std::array<std::string_view, 2> ruling_names{"adopt", "abandon"};
inline constexpr std::array<std::string_view, 4> order_names{"none", "wait", "drain", "stop"};
inline constexpr std::array<std::string_view, 4> receipt_names{"accepted", "duplicate", "stale", "refused"};
constexpr std::span<const std::string_view> names(Of<Ruling>) { return ruling_names; }
constexpr std::span<const std::string_view> names(Of<Order>) { return order_names; }
constexpr std::span<const std::string_view> names(Of<Receipt>) { return receipt_names; }

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

}  // namespace fracfarm::wire
