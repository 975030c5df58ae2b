// The answers of a farm as people read them: pure functions of the JSON that --json prints.
#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace fracfarm::cli {

std::string status_text(const nlohmann::json& status, std::FILE* to);
std::string progress_text(const nlohmann::json& status);  // one line
std::string jobs_text(const nlohmann::json& jobs);
std::string explain_text(const nlohmann::json& explanation, std::FILE* to);
std::string worker_text(const nlohmann::json& worker, std::FILE* to);
std::string clock_text(const std::string& utc);  // 2026-01-31T12:00:00Z as local time of day, with the date where it is another day

}  // namespace fracfarm::cli
