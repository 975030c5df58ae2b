#include "coordinator/cli/farm_link.hpp"

#include <fmt/format.h>

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
constexpr double holder_patience_s = 30.0;  // for another command to let go of the ledger

Result<wire::Client> connect(const std::filesystem::path& farm) {
  const Result<wire::Endpoint> endpoint = wire::read_endpoint(farm);
  if (!endpoint) return tl::unexpected(endpoint.error());
  const Result<wire::KeyPair> key = wire::load_or_make_key(farm, "client");
  if (!key) return tl::unexpected(key.error());
  return wire::Client::connect(endpoint->endpoint, farm, *key);
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
    if (!elsewhere) {
      Result<Ledger> ledger = Ledger::open(paths, make, 0.0);  // a coordinator will not let go of it: no waiting here
      if (ledger) {
        if (Result<void> made = enrol_the_rest(*ledger); !made) return tl::unexpected(made.error());
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

Result<wire::Answer> FarmLink::ask(const std::string& verb, const nlohmann::json& arguments) {
  const wire::Ask request{verb, arguments.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
  if (client_) {
    const Result<wire::Reply> reply = client_->ask(request, answer_timeout_s);
    if (!reply) return tl::unexpected(reply.error());
    if (const auto* answer = std::get_if<wire::Answer>(&*reply)) return *answer;
    return fail(Fault::node_lost, "the coordinator answered something else than was asked");
  }
  SystemClock clock;
  own_->ledger.begin();
  const wire::Answer answer =
      answer_ask(Desk{own_->ledger, own_->book, build_info().build_id, {clock.monotonic_s(), clock.wall_s()}, {}}, request);
  own_->ledger.commit();
  return answer;
}

}  // namespace fracfarm::cli
