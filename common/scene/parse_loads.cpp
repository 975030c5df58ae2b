// The load of one side: "free", "fixed", one object for the whole side, or a list of objects for parts of it.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/text.hpp"
#include "common/scene/parse_parts.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

constexpr std::size_t max_parts = 1000;
constexpr Range speed{-1e4, 1e4, "m/s"};
constexpr Range pressure{-1e13, 1e13, "Pa"};
constexpr std::array<Word<Tangential>, 2> tangential_words{{{"free", Tangential::free}, {"fixed", Tangential::fixed}}};

SideLoad fixed_side(double length) { return {.to = length, .normal_velocity = 0.0, .tangential = Tangential::fixed, .traction = {}}; }

// A part that asks for nothing is a free part; leaving it out makes every spelling of "free" one scene.
bool idle(const SideLoad& part) { return !part.normal_velocity && part.tangential == Tangential::free && !part.traction; }

void read_motion(Fields& fields, SideLoad& part) {
  fields.number("normal_velocity", speed, part.normal_velocity);
  fields.word("tangential", tangential_words, part.tangential);
  if (fields.number("tangential_velocity", speed, part.tangential_velocity)) part.tangential = Tangential::velocity;
  if (fields.has("tangential") && fields.has("tangential_velocity"))
    fields.problems().add(fields.path("tangential"), "given with tangential_velocity", "one of the two", "remove one of the two");
}

// A prescribed motion and a traction on one part would contradict each other.
void check_part(Fields& fields, const SideLoad& part) {
  const bool moves = fields.has("normal_velocity") || fields.has("tangential_velocity") || part.tangential == Tangential::fixed;
  const bool pulls = fields.has("traction") || fields.has("pressure");
  if (moves && pulls)
    fields.problems().add(fields.path(fields.has("traction") ? "traction" : "pressure"), "given with a velocity or a fixed tangent",
                          "either a motion or a traction", "split the side into parts with from and to");
  if (!moves && !pulls && !fields.has("tangential"))
    fields.problems().add(fields.path("normal_velocity"), "(missing)",
                          "one of normal_velocity, tangential_velocity, tangential, traction, pressure",
                          "write \"free\" or \"fixed\" for a side without motion");
  if (!(part.from < part.to))
    fields.problems().add(fields.path("to"), shortest(part.to), fmt::format("above from = {} m", shortest(part.from)));
}

// Pressure p pushes inward: it is the traction -p n.
void read_pressure(Fields& fields, Side side, SideLoad& part) {
  double given = 0.0;
  if (!fields.number("pressure", pressure, given)) return;
  const double inward = side == Side::left || side == Side::bottom ? given : -given;
  part.traction = side == Side::left || side == Side::right ? std::array{inward, 0.0} : std::array{0.0, inward};
  if (fields.has("traction"))
    fields.problems().add(fields.path("pressure"), "given with traction", "one of the two", "remove one of the two");
}

SideLoad read_part(const json& value, const std::string& path, Side side, double length, ProblemList& problems) {
  SideLoad part{.to = length, .normal_velocity = {}, .traction = {}};
  Fields fields(value, path, problems);
  fields.number("from", {0.0, length, "m", false, true}, part.from);
  fields.number("to", {0.0, length, "m", true}, part.to);
  read_motion(fields, part);
  fields.number("ramp", {0.0, 1e3, "s"}, part.ramp);
  if (const json* traction = fields.value("traction")) {
    std::array<double, 2> given{};
    if (read_numbers(*traction, fields.path("traction"), pressure, given, problems)) part.traction = given;
  }
  read_pressure(fields, side, part);
  if (value.is_object()) check_part(fields, part);
  fields.done();
  return part;
}

json part_json(const SideLoad& part, bool whole_side) {
  json out{{"ramp", part.ramp}};
  if (!whole_side) out.update({{"from", part.from}, {"to", part.to}});
  if (part.traction) {
    out["traction"] = *part.traction;
    return out;
  }
  if (part.normal_velocity) out["normal_velocity"] = *part.normal_velocity;
  if (part.tangential == Tangential::velocity)
    out["tangential_velocity"] = part.tangential_velocity;
  else
    out["tangential"] = spelled(tangential_words, part.tangential);
  return out;
}

}  // namespace

double side_length(const Scene& scene, Side side) { return side == Side::left || side == Side::right ? scene.height : scene.width; }

std::vector<SideLoad> read_side(const json& value, const std::string& path, Side side, double length, ProblemList& problems) {
  if (value.is_string()) {
    static constexpr std::array<std::string_view, 2> words{"free", "fixed"};
    const auto index = read_word(value, path, words, {}, problems);
    if (index && *index == 1) return {fixed_side(length)};
    return {};
  }
  if (value.is_object()) {
    const SideLoad part = read_part(value, path, side, length, problems);
    return idle(part) ? std::vector<SideLoad>{} : std::vector<SideLoad>{part};
  }
  if (!value.is_array() || value.size() > max_parts) {
    problems.add(path, printed(value), fmt::format("\"free\", \"fixed\", an object, or a list of at most {} objects", max_parts));
    return {};
  }
  std::vector<SideLoad> parts;
  for (std::size_t i = 0; i < value.size(); ++i) parts.push_back(read_part(value[i], key_path(path, i), side, length, problems));
  std::erase_if(parts, idle);
  std::stable_sort(parts.begin(), parts.end(), [](const SideLoad& a, const SideLoad& b) { return a.from < b.from; });
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i].from < parts[i - 1].to)
      problems.add(path,
                   fmt::format("parts {} - {} and {} - {} m", shortest(parts[i - 1].from), shortest(parts[i - 1].to),
                               shortest(parts[i].from), shortest(parts[i].to)),
                   "parts that do not overlap");
  return parts;
}

json side_json(const std::vector<SideLoad>& parts, double length) {
  if (parts.empty()) return "free";
  if (parts.size() == 1 && parts[0].from == 0.0 && parts[0].to == length)
    return parts[0] == fixed_side(length) ? json("fixed") : part_json(parts[0], true);
  json list = json::array();
  for (const SideLoad& part : parts) list.push_back(part_json(part, false));
  return list;
}

}  // namespace fracfarm
