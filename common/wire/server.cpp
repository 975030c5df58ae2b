// The coordinator's end: one ROUTER socket. It answers whom it is told to answer and knows nothing of what is said.
#include <fmt/format.h>

#include <cmath>
#include <zmq.hpp>

#include "common/base/clock.hpp"
#include "common/wire/socket.hpp"
#include "common/wire/zap.hpp"

namespace fracfarm::wire {
namespace {

void set_options(zmq::socket_t& socket, const KeyPair& own) {
  socket.set(zmq::sockopt::router_mandatory, true);  // without it, sends to a peer that is gone vanish
  socket.set(zmq::sockopt::router_handover, false);  // with it, a peer could take another's routing id
  socket.set(zmq::sockopt::curve_server, true);
  socket.set(zmq::sockopt::curve_secretkey, own.secret_key);
  socket.set(zmq::sockopt::zap_domain, "fracfarm");
  socket.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(max_message_bytes));
  socket.set(zmq::sockopt::handshake_ivl, 10'000);
  socket.set(zmq::sockopt::heartbeat_ivl, 5'000);
  socket.set(zmq::sockopt::heartbeat_timeout, 20'000);
  socket.set(zmq::sockopt::heartbeat_ttl, 20'000);
  socket.set(zmq::sockopt::sndhwm, 64);  // replies waiting for one peer; each has one request under way
  socket.set(zmq::sockopt::rcvhwm, 64);
  socket.set(zmq::sockopt::backlog, 1024);
  socket.set(zmq::sockopt::linger, 200);  // ms for the last replies at shutdown
}

}  // namespace

struct Server::Impl {
  zmq::context_t context{1};
  ZapHandler zap;
  zmq::socket_t socket;
  ServerCounts counts;
  Admission admission;
  SystemClock clock;

  explicit Impl(const std::filesystem::path& farm) : zap(context, farm), socket(context, zmq::socket_type::router), admission(farm) {}

  // The name of a peer whose key is still good; a connection outlives the key that opened it.
  std::string name_of(std::string_view user) {
    if (user.size() <= user_key_length + 1) return {};
    const std::string name(user.substr(0, user.size() - user_key_length - 1)), key(user.substr(user.size() - user_key_length));
    if (admission.still_allowed(name, key, clock.monotonic_s())) return name;
    ++counts.revoked_keys;
    return {};
  }

  // Takes one message off the socket, false where there is none. `incoming` stays without a peer where it was no message of ours.
  bool take(Incoming& incoming) {
    zmq::message_t route, body, rest;
    if (!socket.recv(route, zmq::recv_flags::dontwait)) return false;
    incoming = {};
    if (route.more() && socket.recv(body, zmq::recv_flags::dontwait)) {
      const char* peer = ::zmq_msg_gets(body.handle(), "User-Id");
      if (!body.more() && peer != nullptr) incoming = {route.to_string(), name_of(peer), body.to_string()};
      for (bool more = body.more(); more;) more = socket.recv(rest, zmq::recv_flags::dontwait) && rest.more();
    }
    if (incoming.peer.empty()) ++counts.odd_frames;
    return true;
  }
};

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;
Server::Server(Server&&) noexcept = default;
Server& Server::operator=(Server&&) noexcept = default;

Result<Server> Server::bind(const std::string& endpoint, const std::filesystem::path& farm) {
  const auto own = load_or_make_key(farm, "server");
  if (!own) return tl::unexpected(own.error());
  try {
    auto impl = std::make_unique<Impl>(farm);
    set_options(impl->socket, *own);
    impl->socket.bind(endpoint);
    return Server(std::move(impl));
  } catch (const zmq::error_t& error) {
    return fail(Fault::node_lost, fmt::format("cannot listen at {}: {}", endpoint, error.what()));
  }
}

std::string Server::endpoint() const { return impl_->socket.get(zmq::sockopt::last_endpoint); }

std::vector<Incoming> Server::receive(std::size_t max, double timeout_s) {
  std::vector<Incoming> all;
  try {
    zmq::pollitem_t item{impl_->socket.handle(), 0, ZMQ_POLLIN, 0};
    if (zmq::poll(&item, 1, std::chrono::milliseconds(std::lround(timeout_s * 1e3))) == 0) return all;
    Incoming incoming;
    while (all.size() < max && impl_->take(incoming))
      if (!incoming.peer.empty()) all.push_back(std::move(incoming));
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;  // a signal: the caller looks at it; anything else is a broken context
  }
  return all;
}

bool Server::send(const std::string& route, std::string_view bytes) {
  try {
    const bool sent = impl_->socket.send(zmq::buffer(route), zmq::send_flags::sndmore | zmq::send_flags::dontwait) &&
                      impl_->socket.send(zmq::buffer(bytes), zmq::send_flags::dontwait);
    if (!sent) ++impl_->counts.unsendable;
    return sent;
  } catch (const zmq::error_t&) {  // EHOSTUNREACH: it is gone
    ++impl_->counts.unsendable;
    return false;
  }
}

bool Server::healthy() const { return impl_->zap.alive(); }

ServerCounts Server::counts() const {
  ServerCounts counts = impl_->counts;
  counts.unknown_keys = impl_->zap.refused();
  return counts;
}

}  // namespace fracfarm::wire
