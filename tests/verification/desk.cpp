#include "tests/verification/desk.hpp"

#include <fmt/format.h>

#include "common/base/text.hpp"

namespace fracfarm::verification {

void Desk::progress(std::string_view what, double share_of_part) {
  const double share = begin_ + length_ * share_of_part;
  const double now = clock_.monotonic_s();
  if (now - last_s_ < 0.25 || now - start_s_ < 1.0) return;
  last_s_ = now;
  const double left = share > 0.0 ? (now - start_s_) * (1.0 - share) / share : 0.0;
  line_.show(fmt::format("{} {}: {:.0f} %, about {} left", id_, what, 100.0 * share, duration_text(left)));
}

}  // namespace fracfarm::verification
