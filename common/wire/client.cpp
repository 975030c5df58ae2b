// A worker's or a verb's end: one request at a time. Silence is met with a new socket and the same request id, so that a lost reply, a
// restarted coordinator and a new port all look alike: the answer comes later.
#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <cmath>
#include <zmq.hpp>

#include "common/base/clock.hpp"
#include "common/wire/codec.hpp"
#include "common/wire/endpoint.hpp"
#include "common/wire/socket.hpp"

namespace fracfarm::wire {
namespace {

constexpr double first_silence_s = 2.0;  // before the first resend
constexpr double longest_silence_s = 15.0;
constexpr double look_interval_s = 0.25;  // at endpoint.json while waiting

// Request ids never repeat for one key, whichever process of that key made them.
std::uint64_t random_start() {
  std::uint64_t id = 0;
  if (::getrandom(&id, sizeof id, 0) != sizeof id) id = static_cast<std::uint64_t>(SystemClock().wall_s() * 1e9);
  return id >> 2;
}

void set_options(zmq::socket_t& socket, const KeyPair& own, const std::string& server_key) {
  socket.set(zmq::sockopt::curve_publickey, own.public_key);
  socket.set(zmq::sockopt::curve_secretkey, own.secret_key);
  socket.set(zmq::sockopt::curve_serverkey, server_key);
  socket.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(max_message_bytes));
  socket.set(zmq::sockopt::handshake_ivl, 10'000);
  socket.set(zmq::sockopt::heartbeat_ivl, 5'000);
  socket.set(zmq::sockopt::heartbeat_timeout, 20'000);
  socket.set(zmq::sockopt::reconnect_ivl, 100);
  socket.set(zmq::sockopt::reconnect_ivl_max, 2'000);
  socket.set(zmq::sockopt::linger, 0);
}

}  // namespace

struct Client::Impl {
  std::filesystem::path farm;
  EndpointReader reader{farm};
  KeyPair own;
  bool kept_in_farm = false;  // `own` is the farm's pair of its name: where that is replaced, so is this
  Endpoint given;             // as connect was told; used where there is no endpoint.json
  Endpoint current;
  zmq::context_t context{1};
  zmq::socket_t socket;
  SystemClock clock;
  std::uint64_t request_id = random_start();
  std::string pending;  // the request without a reply yet; empty: none
  double sent_at = 0.0;
  double looked_at = 0.0;
  double silence_s = first_silence_s;

  explicit Impl(std::filesystem::path folder) : farm(std::move(folder)) {}
  Endpoint where() { return reader.read().value_or(given); }

  Result<void> reconnect() {
    if (kept_in_farm)
      if (Result<KeyPair> pair = load_or_make_key(farm, own.name)) own = std::move(*pair);
    const auto server_key = server_public_key(farm);
    if (!server_key) return tl::unexpected(server_key.error());
    try {
      current = where();
      socket = zmq::socket_t(context, zmq::socket_type::dealer);
      set_options(socket, own, *server_key);
      socket.connect(current.endpoint);
      return {};
    } catch (const zmq::error_t& error) {
      return fail(Fault::node_lost, fmt::format("cannot connect to {}: {}", current.endpoint, error.what()));
    }
  }

  void send_pending() {
    sent_at = clock.monotonic_s();
    try {
      (void)socket.send(zmq::buffer(pending), zmq::send_flags::dontwait);  // not sent: met as silence
    } catch (const zmq::error_t&) {
    }
  }

  // Sends again through a new socket after silence, or at once where the coordinator has moved.
  void resend_if_due() {
    const double now = clock.monotonic_s();
    bool moved = false;
    if (now - looked_at >= look_interval_s) {
      looked_at = now;
      moved = where() != current;
    }
    if (!moved && now - sent_at < silence_s) return;
    silence_s = moved ? first_silence_s : std::min(1.5 * silence_s, longest_silence_s);
    sent_at = now;
    if (reconnect()) send_pending();  // where it cannot, the next silence tries again
  }

  // Reads all that is there: a socket tells of a message only where it had none before.
  std::optional<Result<Reply>> take() {
    std::optional<Result<Reply>> taken;
    zmq::message_t message;
    try {
      while (socket.recv(message, zmq::recv_flags::dontwait)) {
        if (auto mine = reply_in(message.to_string_view()); mine && !taken) taken = std::move(mine);
      }
    } catch (const zmq::error_t&) {  // EINTR, or a socket that a reconnect will replace
    }
    return taken;
  }

  // Nothing where it is late: of a request that was answered already.
  std::optional<Result<Reply>> reply_in(std::string_view bytes) {
    auto reply = decode_reply(bytes);
    if (!reply) return Result<Reply>(tl::unexpected(reply.error()));
    const auto* refusal = std::get_if<Refusal>(&reply->reply);
    const bool mine = !pending.empty() && (reply->request_id == request_id || (refusal && reply->request_id == 0));
    if (!mine) return std::nullopt;
    pending.clear();
    silence_s = first_silence_s;
    if (refusal) return Result<Reply>(fail(Fault::bad_request, "the coordinator refused: " + refusal->reason));
    return Result<Reply>(std::move(reply->reply));
  }

  void wait(double seconds) {
    try {
      zmq::pollitem_t item{socket.handle(), 0, ZMQ_POLLIN, 0};
      zmq::poll(&item, 1, std::chrono::milliseconds(std::max(1L, std::lround(seconds * 1e3))));
    } catch (const zmq::error_t&) {
    }
  }
};

Client::Client(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Client::~Client() = default;
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;

Result<Client> Client::connect(const std::string& endpoint, const std::filesystem::path& farm, const KeyPair& own) {
  auto impl = std::make_unique<Impl>(farm);
  impl->own = own;
  impl->given = {endpoint, 0, 0};
  if (const Result<KeyPair> pair = load_key(farm, own.name)) impl->kept_in_farm = pair->public_key == own.public_key;
  if (auto connected = impl->reconnect(); !connected) return tl::unexpected(connected.error());
  return Client(std::move(impl));
}

Result<void> Client::post(const Request& request) {
  std::string bytes = encode(RequestEnvelope{impl_->request_id + 1, request});
  if (bytes.size() > max_message_bytes)
    return fail(Fault::bad_request, fmt::format("request of {} bytes; the limit is {}", bytes.size(), max_message_bytes));
  ++impl_->request_id;
  impl_->pending = std::move(bytes);
  impl_->silence_s = first_silence_s;
  if (impl_->where() != impl_->current) (void)impl_->reconnect();
  impl_->send_pending();
  return {};
}

Result<std::optional<Reply>> Client::poll(double timeout_s) {
  const double deadline = impl_->clock.monotonic_s() + timeout_s;
  for (;;) {
    if (auto taken = impl_->take()) {
      if (!*taken) return tl::unexpected(taken->error());
      return std::optional<Reply>(std::move(**taken));
    }
    if (impl_->pending.empty()) return std::optional<Reply>();
    impl_->resend_if_due();
    const double left = deadline - impl_->clock.monotonic_s();
    if (left <= 0.0) return std::optional<Reply>();
    impl_->wait(std::min(left, look_interval_s));
  }
}

Result<Reply> Client::ask(const Request& request, double timeout_s) {
  const double deadline = impl_->clock.monotonic_s() + timeout_s;
  if (auto posted = post(request); !posted) return tl::unexpected(posted.error());
  for (;;) {
    auto reply = poll(std::max(0.0, deadline - impl_->clock.monotonic_s()));
    if (!reply) return tl::unexpected(reply.error());
    if (*reply) return std::move(**reply);
    if (impl_->clock.monotonic_s() >= deadline) {
      impl_->pending.clear();
      return fail(Fault::node_lost,
                  fmt::format("no answer from the coordinator at {} within {:.0f} s", impl_->current.endpoint, timeout_s));
    }
  }
}

bool Client::readable() const { return (impl_->socket.get(zmq::sockopt::events) & ZMQ_POLLIN) != 0; }
int Client::descriptor() const { return impl_->socket.get(zmq::sockopt::fd); }
std::uint64_t Client::epoch() const { return impl_->current.epoch; }

}  // namespace fracfarm::wire
