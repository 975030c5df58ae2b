// Shared by the files that answer requests: safe access to arguments, JSON of rows.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/requests.hpp"

namespace fracfarm::desk {

wire::Answer answer_json(const nlohmann::json& body, int exit_code = 0);
wire::Answer answer_error(int exit_code, const std::string& message);             // fracfarm.error/1
wire::Answer answer_problems(const Problems& problems, const std::string& what);  // fracfarm.problems/1, exit_bad_input

// An argument of the wrong type reads as absent.
std::string text_of(const nlohmann::json& arguments, const char* name);
bool flag_of(const nlohmann::json& arguments, const char* name);
std::optional<std::int64_t> integer_of(const nlohmann::json& arguments, const char* name);
std::vector<std::string> list_of(const nlohmann::json& arguments, const char* name);  // numbers come as text

nlohmann::json job_json(const Job& job);
// By id, or by the first 4 or more characters of its key. Errors: BAD_REQUEST where there is none or more than one.
Result<Job> find_job(const Desk& desk, const std::string& word);

wire::Answer status(const Desk& desk, const nlohmann::json& arguments);
wire::Answer jobs(const Desk& desk, const nlohmann::json& arguments);
wire::Answer explain(const Desk& desk, const nlohmann::json& arguments);
wire::Answer records(const Desk& desk, const nlohmann::json& arguments);
wire::Answer learned(const Desk& desk, const nlohmann::json& arguments);
wire::Answer known(const Desk& desk, const nlohmann::json& arguments);
wire::Answer submit(const Desk& desk, const nlohmann::json& arguments);
wire::Answer retry(const Desk& desk, const nlohmann::json& arguments);
wire::Answer cancel(const Desk& desk, const nlohmann::json& arguments);
wire::Answer release(const Desk& desk, const nlohmann::json& arguments);
wire::Answer hold(const Desk& desk, const nlohmann::json& arguments);
wire::Answer priority(const Desk& desk, const nlohmann::json& arguments);
wire::Answer drain(const Desk& desk, const nlohmann::json& arguments);
wire::Answer pause(const Desk& desk, const nlohmann::json& arguments);
wire::Answer resume(const Desk& desk, const nlohmann::json& arguments);
wire::Answer worker(const Desk& desk, const nlohmann::json& arguments);
wire::Answer failures(const Desk& desk, const nlohmann::json& arguments);
wire::Answer cases(const Desk& desk, const nlohmann::json& arguments);
wire::Answer recheck(const Desk& desk, const nlohmann::json& arguments);

}  // namespace fracfarm::desk
