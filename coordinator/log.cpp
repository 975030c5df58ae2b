#include "coordinator/log.hpp"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/rotating_file_sink.h>

#include <nlohmann/json.hpp>

#include "common/base/terminal.hpp"

namespace fracfarm {
namespace {

constexpr std::size_t file_bytes = 10u << 20;
constexpr std::size_t files = 3;

}  // namespace

CoordinatorLog::CoordinatorLog(const std::filesystem::path& folder, bool quiet) : quiet_(quiet) {
  try {
    const auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_st>((folder / "coordinator.jsonl").string(), file_bytes, files);
    file_ = std::make_shared<spdlog::logger>("coordinator", sink);
    file_->set_formatter(std::make_unique<spdlog::pattern_formatter>(R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l","message":%v})",
                                                                     spdlog::pattern_time_type::utc));
    file_->flush_on(spdlog::level::info);
  } catch (const spdlog::spdlog_ex& error) {
    fmt::print(stderr, "coordinator: no log file: {}\n", error.what());
  }
}

CoordinatorLog::~CoordinatorLog() = default;

void CoordinatorLog::say(Level level, std::string_view text) {
  constexpr spdlog::level::level_enum levels[] = {spdlog::level::info, spdlog::level::warn, spdlog::level::err};
  constexpr Ink inks[] = {Ink::plain, Ink::yellow, Ink::red};
  if (file_)
    file_->log(levels[static_cast<int>(level)], nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  if (quiet_ && level == Level::info) return;
  fmt::print(stderr, "{} {}\n", ink("coordinator:", Ink::dim, stderr), ink(text, inks[static_cast<int>(level)], stderr));
}

}  // namespace fracfarm
