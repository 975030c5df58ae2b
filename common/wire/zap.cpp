#include "common/wire/zap.hpp"

#include <array>
#include <chrono>
#include <vector>
#include <zmq_addon.hpp>

namespace fracfarm::wire {
namespace {

// Frames of a request: version, request id, domain, address, identity, mechanism, credentials (32 bytes of the public key for CURVE).
constexpr std::size_t request_frames = 7;

std::string z85(const zmq::message_t& key) {
  std::array<char, 41> text{};
  return key.size() == 32 && ::zmq_z85_encode(text.data(), key.data<std::uint8_t>(), 32) ? text.data() : "";
}

}  // namespace

ZapHandler::ZapHandler(zmq::context_t& context, std::filesystem::path farm)
    : admission_(std::move(farm)), socket_(context, zmq::socket_type::rep) {
  socket_.set(zmq::sockopt::linger, 0);
  socket_.bind("inproc://zeromq.zap.01");
  thread_ = std::thread([this] { serve(); });
}

ZapHandler::~ZapHandler() {
  stop_ = true;
  thread_.join();
}

void ZapHandler::serve() {
  try {
    while (!stop_) {
      zmq::pollitem_t item{socket_.handle(), 0, ZMQ_POLLIN, 0};
      zmq::poll(&item, 1, std::chrono::milliseconds(50));
      if (item.revents & ZMQ_POLLIN) answer_one();
    }
  } catch (...) {  // whatever it was: the owner must see that the door is unattended
  }
  alive_ = false;
}

void ZapHandler::answer_one() {
  std::vector<zmq::message_t> frames;
  if (!zmq::recv_multipart(socket_, std::back_inserter(frames))) return;
  const std::string id = frames.size() > 1 ? frames[1].to_string() : "";
  std::string name, key;
  if (frames.size() == request_frames && frames[5].to_string_view() == "CURVE") {
    key = z85(frames[6]);
    name = admission_.name_of_key(key);
  }
  const std::string user = name.empty() ? std::string() : user_id(name, key);
  if (name.empty()) ++refused_;
  const std::array<zmq::const_buffer, 6> reply{zmq::str_buffer("1.0"),
                                               zmq::buffer(id),
                                               name.empty() ? zmq::const_buffer("400", 3) : zmq::const_buffer("200", 3),
                                               name.empty() ? zmq::const_buffer("key not allowed", 15) : zmq::const_buffer("OK", 2),
                                               zmq::buffer(user),
                                               zmq::str_buffer("")};
  zmq::send_multipart(socket_, reply);
}

}  // namespace fracfarm::wire
