#include "solver/program/scene_file.hpp"

#include <fmt/format.h>

#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/base/atomic_file.hpp"
#include "common/base/exit_code.hpp"
#include "common/base/terminal.hpp"

namespace fracfarm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t scene_limit = std::uint64_t{16} << 20;  // bytes

}  // namespace

Result<std::string> scene_text(const std::string& path) {
  if (path != "-") return read_file(path, scene_limit);
  std::string text(std::istreambuf_iterator<char>(std::cin), {});
  if (text.size() > scene_limit)
    return fail(Fault::bad_request, fmt::format("the scene has {} bytes, the limit is {}", text.size(), scene_limit));
  return text;
}

int report_problems(const Problems& problems, const std::string& scene, bool json) {
  if (json) {
    Json list = Json::array();
    for (const Problem& p : problems)
      list.push_back({{"key", p.key}, {"value", p.value}, {"limit", p.limit}, {"suggestion", p.suggestion}});
    const Json out{{"schema", "fracfarm.problems/1"}, {"what", scene}, {"problems", list}};
    fmt::print("{}\n", out.dump(2, ' ', false, Json::error_handler_t::replace));
    return exit_bad_input;
  }
  fmt::print(stderr, "{} {}: {} problem{}\n", ink("error:", Ink::red, stderr), scene, problems.size(), problems.size() == 1 ? "" : "s");
  for (const Problem& p : problems) {
    fmt::print(stderr, "  {} = {}; allowed: {}{}{}\n", ink(p.key, Ink::bold, stderr), p.value, p.limit, p.suggestion.empty() ? "" : "; ",
               p.suggestion);
  }
  return exit_bad_input;
}

}  // namespace fracfarm
