// One message of every kind with every field away from its default, for the tests of the codec.
#pragma once

#include <string>
#include <vector>

#include "common/wire/messages.hpp"

namespace fracfarm::wire {

inline std::vector<Request> sample_requests() {
  const std::string key(64, 'a');
  const LeaseId lease{7, 18446744073709551615ull};
  Completion completion{lease, key, Verdict::failed, 4.25e-5, "through_crack", 6.91e6, 1234, 0.19, 0.21, "shard-w-1.tar", 512, 750000, key};
  Completion censored = completion;
  censored.time_to_failure.reset();
  return {Hello{"node-1", "instance", 16, 64ull << 30, "0.1.0-abc", 3600.0, {{lease, key, 17}}},
          Next{{completion, censored}, {{lease, key, Fault::out_of_memory, "killed: \xC3\xA9", "SIGKILL"}}, {lease}, 3, -1.0},
          Beat{{{lease, key, 99}, {lease, key, -1}}}, Bye{{lease, lease}}, Ask{"status", R"({"json": true})"}};
}

inline std::vector<Reply> sample_replies() {
  const std::string key(64, 'b');
  return {Welcome{12, 2.5, 20.0, {Ruling::adopt, Ruling::abandon}},
          Jobs{{Receipt::accepted, Receipt::duplicate, Receipt::stale, Receipt::refused},
               {{{12, 1}, key, 42, 2, R"({"schema":"fracfarm.scene/1"})", 30.0, 0.5, "store"}},
               Order::drain,
               1.5},
          BeatReply{{Ruling::abandon}, Order::stop},
          ByeReply{},
          Answer{5, "{}"},
          Refusal{"protocol version 9 is not spoken here"}};
}

}  // namespace fracfarm::wire
