// fracfarm metrics: the status as Prometheus text.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/exit_code.hpp"
#include "coordinator/cli/farm_verbs.hpp"
#include "coordinator/cli/metrics_text.hpp"
#include "coordinator/cli/options.hpp"

namespace fracfarm::cli {

int run_metrics(int argc, char** argv) {
  FarmOptions options;
  Command app{
      "The status as Prometheus text: fracfarm metrics > DIR/fracfarm.prom.new && mv DIR/fracfarm.prom.new DIR/fracfarm.prom, with DIR the "
      "node "
      "exporter's textfile folder.",
      "fracfarm metrics"};
  app.add_option("--farm", options.farm, "folder of the farm").with_default_shown();
  if (const auto status = app.parse(argc, argv)) return *status;
  return guarded(options, [&] {
    Result<FarmLink> link = FarmLink::open(options.farm);
    if (!link) return report_unreachable(link.error(), false);
    const Result<wire::Answer> answer = link->ask("status", nlohmann::json::object());
    if (!answer) return report_unreachable(answer.error(), false);
    fmt::print("{}", metrics_text(nlohmann::json::parse(answer->body)));
    return static_cast<int>(exit_ok);
  });
}

}  // namespace fracfarm::cli
