#include "worker/log.hpp"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/rotating_file_sink.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/base/terminal.hpp"

namespace fracfarm::worker {
namespace {

using nlohmann::json;

constexpr std::size_t file_bytes = 10u << 20;
constexpr std::size_t files = 3;

spdlog::level::level_enum level_of(Say::Level level) {
  switch (level) {
    case Say::Level::info:
      return spdlog::level::info;
    case Say::Level::warning:
      return spdlog::level::warn;
    case Say::Level::error:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

std::string quoted(std::string_view text) { return json(text).dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

Log::Log(const std::filesystem::path& farm, const std::string& name, bool quiet) : name_(name), quiet_(quiet) {
  try {
    const auto sink =
        std::make_shared<spdlog::sinks::rotating_file_sink_st>((farm / "log" / (name + ".jsonl")).string(), file_bytes, files);
    file_ = std::make_shared<spdlog::logger>(name, sink);
    file_->set_formatter(std::make_unique<spdlog::pattern_formatter>(R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l","worker":"%n",%v})",
                                                                     spdlog::pattern_time_type::utc));
    file_->flush_on(spdlog::level::info);
  } catch (const spdlog::spdlog_ex& error) {
    fmt::print(stderr, "{}: no log file: {}\n", name_, error.what());
  }
}

Log::~Log() = default;

void Log::say(Say::Level level, std::string_view text) {
  if (file_) file_->log(level_of(level), "\"message\":{}", quoted(text));
  if (quiet_ && level == Say::Level::info) return;
  const Ink colour = level == Say::Level::error ? Ink::red : level == Say::Level::warning ? Ink::yellow : Ink::plain;
  fmt::print(stderr, "{} {}\n", ink(name_ + ":", Ink::dim, stderr), ink(text, colour, stderr));
}

void Log::job(std::uint64_t job, std::string_view event, std::string_view detail) {
  if (!file_) return;
  if (detail.empty())
    file_->info("\"job\":{},\"event\":{}", job, quoted(event));
  else
    file_->info("\"job\":{},\"event\":{},\"detail\":{}", job, quoted(event), quoted(detail));
}

}  // namespace fracfarm::worker
