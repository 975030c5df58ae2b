#include "worker/identity.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

namespace fracfarm::worker {
namespace {

constexpr int most_workers_a_node = 1000;

}  // namespace

Result<Identity> Identity::claim(const std::filesystem::path& farm, const std::string& node) {
  const std::filesystem::path keys = farm / "keys";
  std::error_code error;
  std::filesystem::create_directories(keys, error);
  if (!error) std::filesystem::permissions(keys, std::filesystem::perms::owner_all, error);
  if (error) return fail(Fault::node_lost, fmt::format("cannot make {}: {}", keys.string(), error.message()));
  for (int n = 0; n < most_workers_a_node; ++n) {
    const std::string name = fmt::format("worker-{}-{}", name_of_node(node), n);
    const std::filesystem::path lock = keys / (name + ".lock");
    const int fd = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0) return fail(Fault::node_lost, fmt::format("cannot open {}: {}", lock.string(), std::strerror(errno)));
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) return Identity(name, fd);
    ::close(fd);
  }
  return fail(Fault::bad_request,
              fmt::format("{} workers run on {} already; the limit is {}", most_workers_a_node, node, most_workers_a_node));
}

Identity::~Identity() {
  if (fd_ >= 0) ::close(fd_);
}
Identity::Identity(Identity&& other) noexcept : name_(std::move(other.name_)), fd_(std::exchange(other.fd_, -1)) {}
Identity& Identity::operator=(Identity&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(fd_, other.fd_);
  return *this;
}

std::string random_instance() {
  std::array<unsigned char, 8> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return fmt::format("pid-{}", ::getpid());
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

std::string name_of_node(const std::string& host) {
  std::string name;
  for (const char c : host.substr(0, 40)) {
    const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const bool plain = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9') || lower == '.' || lower == '-';
    name += plain ? lower : '_';
  }
  return name.empty() ? "node" : name;
}

}  // namespace fracfarm::worker
