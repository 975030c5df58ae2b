#include "worker/identity.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

namespace fracfarm::worker {
namespace {

constexpr int most_workers_a_node = 1000;

// The number of this start, larger than any before it: one more than the lock's file has, and not less than the milliseconds of now.
Result<std::uint64_t> next_start(int fd, double wall_s) {
  std::array<char, 32> text{};
  std::uint64_t before = 0;
  const ssize_t read = ::pread(fd, text.data(), text.size(), 0);
  if (read > 0) std::from_chars(text.data(), text.data() + read, before);
  const std::uint64_t number = std::max(before + 1, static_cast<std::uint64_t>(std::max(0.0, wall_s) * 1e3));
  const std::string line = fmt::format("{:020}\n", number);  // always as long: it takes the place of the one before whole
  if (::pwrite(fd, line.data(), line.size(), 0) != static_cast<ssize_t>(line.size()))
    return fail(Fault::node_lost, fmt::format("cannot write the number of this start: {}", std::strerror(errno)));
  return number;
}

}  // namespace

Result<Identity> Identity::claim(const std::filesystem::path& farm, const std::string& node, double wall_s) {
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
    if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
      ::close(fd);
      continue;
    }
    Identity claimed(name, {}, fd);
    const Result<std::uint64_t> number = next_start(fd, wall_s);
    if (!number) return tl::unexpected(number.error());
    claimed.instance_ = instance_of_start(*number);
    return claimed;
  }
  return fail(Fault::bad_request,
              fmt::format("{} workers run on {} already; the limit is {}", most_workers_a_node, node, most_workers_a_node));
}

Identity::~Identity() {
  if (fd_ >= 0) ::close(fd_);
}
Identity::Identity(Identity&& other) noexcept
    : name_(std::move(other.name_)), instance_(std::move(other.instance_)), fd_(std::exchange(other.fd_, -1)) {}
Identity& Identity::operator=(Identity&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(instance_, other.instance_);
  std::swap(fd_, other.fd_);
  return *this;
}

std::string instance_of_start(std::uint64_t number) {
  std::array<unsigned char, 4> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) bytes = {};
  std::string text = fmt::format("start-{:020}-", number);
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
