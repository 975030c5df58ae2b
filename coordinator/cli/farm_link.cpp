#include "coordinator/cli/farm_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/wire/endpoint.hpp"
#include "coordinator/enrolment.hpp"
#include "coordinator/requests.hpp"

namespace fracfarm::cli {
namespace {

constexpr double answer_timeout_s = 30.0;
constexpr double look_interval_s = 0.5;     // for a coordinator that has ended
constexpr double holder_patience_s = 30.0;  // for another command to let go of the ledger

Result<wire::Client> connect(const std::filesystem::path& farm) {
  const Result<wire::Endpoint> endpoint = wire::read_endpoint(farm);
  if (!endpoint) return tl::unexpected(endpoint.error());
  const Result<wire::KeyPair> key = wire::load_or_make_key(farm, "client");
  if (!key) return tl::unexpected(key.error());
  return wire::Client::connect(endpoint->endpoint, farm, *key);
}

bool writes_nothing(const std::string& verb) {
  const auto rows = requests();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const RequestRow& it) { return it.verb == verb; });
  return row != rows.end() && !row->writes;
}

// The farm's ledger with every campaign in it whole. A coordinator that has it will not let go: no waiting here.
Result<Ledger> open_ledger(const FarmPaths& paths, bool make) {
  Result<Ledger> ledger = Ledger::open(paths, make, 0.0);
  if (!ledger) return ledger;
  if (Result<void> made = enrol_the_rest(*ledger); !made) return tl::unexpected(made.error());
  return ledger;
}

}  // namespace

Result<FarmLink> FarmLink::open(const std::filesystem::path& farm, bool make) {
  const FarmPaths paths{farm};
  SystemClock clock;
  const double last_s = clock.monotonic_s() + holder_patience_s;
  std::error_code none;
  for (;;) {
    // The ledger may lie on another machine's local disk: then only the coordinator can answer.
    const bool elsewhere = !std::filesystem::exists(paths.ledger(), none) && std::filesystem::exists(paths.endpoint(), none);
    FarmLink link;
    link.farm_ = farm;
    if (!elsewhere) {
      Result<Ledger> ledger = open_ledger(paths, make);
      if (ledger) {
        link.own_ = std::make_unique<Own>(Own{std::move(*ledger), {}});
        return link;
      }
      const bool held = ledger.error().message.find("held by another") != std::string::npos;
      if (!held || clock.monotonic_s() > last_s) return tl::unexpected(ledger.error());
    }
    if (elsewhere || (last_holder(paths) == holder_coordinator && std::filesystem::exists(paths.endpoint(), none))) {
      Result<wire::Client> client = connect(farm);
      if (!client) return tl::unexpected(client.error());
      link.client_.emplace(std::move(*client));
      return link;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

// Once it has ended its ledger is free.
bool FarmLink::take_over() {
  Result<Ledger> ledger = open_ledger(FarmPaths{farm_}, false);
  if (!ledger) return false;
  own_ = std::make_unique<Own>(Own{std::move(*ledger), {}});
  client_.reset();
  return true;
}

Result<wire::Reply> FarmLink::wait_for_coordinator(const wire::Ask& request) {
  if (!writes_nothing(request.verb)) return client_->ask(request, answer_timeout_s);
  if (auto posted = client_->post(request); !posted) return tl::unexpected(posted.error());
  SystemClock clock;
  const double last_s = clock.monotonic_s() + answer_timeout_s;
  while (clock.monotonic_s() < last_s) {
    Result<std::optional<wire::Reply>> reply = client_->poll(look_interval_s);
    if (!reply) return tl::unexpected(reply.error());
    if (*reply) return std::move(**reply);
    if (take_over()) return fail(Fault::node_lost, "the coordinator has ended");
  }
  return fail(Fault::node_lost, fmt::format("no answer from the coordinator within {:.0f} s", answer_timeout_s));
}

Result<wire::Answer> FarmLink::ask(const std::string& verb, const nlohmann::json& arguments) {
  const wire::Ask request{verb, arguments.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
  if (client_) {
    const Result<wire::Reply> reply = wait_for_coordinator(request);
    if (!reply && !own_) return tl::unexpected(reply.error());
    if (reply) {
      if (const auto* answer = std::get_if<wire::Answer>(&*reply)) return *answer;
      return fail(Fault::node_lost, "the coordinator answered something else than was asked");
    }
  }
  SystemClock clock;
  own_->ledger.begin();
  const wire::Answer answer =
      answer_ask(Desk{own_->ledger, own_->book, build_info().build_id, {clock.monotonic_s(), clock.wall_s()}, {}}, request);
  own_->ledger.commit();
  return answer;
}

}  // namespace fracfarm::cli
