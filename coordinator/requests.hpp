// What people ask: the table of requests. Whoever holds the ledger answers: the coordinator where one runs, else the verb itself, by the
// same functions. Arguments and answers are JSON objects; every answer names its schema and version.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/wire/messages.hpp"
#include "coordinator/campaign_book.hpp"
#include "coordinator/ledger.hpp"
#include "coordinator/roster.hpp"

namespace fracfarm {

struct LiveWorker {
  std::string name;  // of its key
  std::string node;
  std::string state;  // working, draining, silent, suspect, or stopped (too many fast faults in a row)
  int slots = 0;
  int running = 0;
  double remaining_s = -1.0;  // < 0: unlimited
  double silent_s = 0.0;
  std::uint64_t done = 0;
  std::uint64_t faults = 0;
  std::string node_type;
};

// What only a running coordinator knows.
struct Live {
  std::uint64_t epoch = 0;
  double rate_per_s = 0.0;
  std::vector<LiveWorker> workers;
  std::map<std::int64_t, long long> steps;  // of running jobs, by the last beat
};

// What an answer is made from. `live` is empty where no coordinator runs.
struct Desk {
  Ledger& ledger;
  CampaignBook& book;
  const std::string& build_id;  // of this program
  Instant now;
  std::function<Live()> live;
};

struct RequestRow {
  std::string_view verb;
  bool writes;
  std::span<const std::string_view> arguments;  // names that it knows; others are refused with a suggestion
  wire::Answer (*answer)(const Desk& desk, const nlohmann::json& arguments);
  std::string_view meaning;
};
std::span<const RequestRow> requests();

// Never throws on hostile input: unknown verbs, arguments and bytes become answers with exit_bad_input. Within the caller's transaction.
wire::Answer answer_ask(const Desk& desk, const wire::Ask& ask);

bool is_settled(Database& ledger);  // nothing is READY, LEASED or waiting, and every campaign has been made jobs

}  // namespace fracfarm
