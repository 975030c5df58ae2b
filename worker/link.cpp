#include "worker/link.hpp"

#include <limits>
#include <utility>

namespace fracfarm::worker {
namespace {

constexpr double try_interval_s = 0.5;  // for the farm's first coordinator to appear

}  // namespace

Link::Link(std::filesystem::path farm, wire::KeyPair own, Clock& clock) : farm_(std::move(farm)), own_(std::move(own)), clock_(clock) {}

void Link::connect() {
  try_at_ = clock_.monotonic_s() + try_interval_s;
  auto client = wire::Client::connect("", farm_, own_);
  trouble_ = client ? "" : client.error().message;
  if (!client) return;
  client_.emplace(std::move(*client));
  epoch_ = client_->epoch();
}

void Link::post(const wire::Request& request) {
  if (!client_) connect();
  if (!client_) {
    unsent_ = request;
    return;
  }
  if (const auto posted = client_->post(request); !posted) refused_here_ = posted.error().message;
}

std::vector<Event> Link::hear() {
  std::vector<Event> events;
  if (!client_ && unsent_ && clock_.monotonic_s() >= try_at_) {
    connect();
    if (client_) post(*std::exchange(unsent_, std::nullopt));
  }
  if (!refused_here_.empty()) events.push_back(RequestRefused{std::exchange(refused_here_, {})});
  if (!client_) return events;
  auto reply = client_->poll(0.0);
  if (std::exchange(epoch_, client_->epoch()) != client_->epoch()) events.push_back(CoordinatorChanged{});
  if (!reply)
    events.push_back(RequestRefused{reply.error().message});
  else if (*reply)
    events.push_back(ReplyCame{std::move(**reply)});
  return events;
}

int Link::descriptor() const { return client_ ? client_->descriptor() : -1; }

double Link::next_try() const {
  if (client_ && client_->readable()) return 0.0;  // the descriptor has told of it already
  return unsent_ ? try_at_ : std::numeric_limits<double>::infinity();
}

}  // namespace fracfarm::worker
