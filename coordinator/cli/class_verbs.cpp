// Verbs on classes of jobs and on results: pause, resume, recheck.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "coordinator/cli/change.hpp"
#include "coordinator/cli/options.hpp"

namespace fracfarm::cli {
namespace {

using nlohmann::json;

struct ClassChoice {
  std::string method, material, load, reason;
  bool dry_run = false;
  void add_to(Command& app) {
    app.add_option("--method", method, "of this method");
    app.add_option("--material", material, "of this material");
    app.add_option("--load", load, "uniaxial or biaxial");
    app.add_flag("--dry-run", dry_run, "say what would change, change nothing");
  }
  json arguments() const {
    json it{{"dry_run", dry_run}};
    for (const auto& [name, value] : {std::pair{"method", &method}, {"material", &material}, {"load", &load}, {"reason", &reason}})
      if (!value->empty()) it[name] = *value;
    return it;
  }
};

}  // namespace

int run_pause(int argc, char** argv) {
  FarmOptions options;
  ClassChoice choice;
  Command app{"Nothing more of these classes is handed out until fracfarm resume; what runs goes on. Without a choice: the whole farm.",
              "fracfarm pause"};
  add_farm_options(app, options);
  choice.add_to(app);
  app.add_option("--reason", choice.reason, "words for those who ask why");
  if (const auto status = app.parse(argc, argv)) return *status;
  return change(options, "pause", choice.arguments(), {"paused:", " class", "es"});
}

int run_resume(int argc, char** argv) {
  FarmOptions options;
  ClassChoice choice;
  Command app{"Paused classes go on: those that a person paused, and those whose fuse blew.", "fracfarm resume"};
  add_farm_options(app, options);
  choice.add_to(app);
  if (const auto status = app.parse(argc, argv)) return *status;
  return change(options, "resume", choice.arguments(), {"resumed:", " class", "es"});
}

int run_recheck(int argc, char** argv) {
  FarmOptions options;
  std::vector<std::string> jobs;
  bool repair = false, dry_run = false;
  Command app{
      "Computes jobs that are done again, on another node where there is one, and compares: a difference raises an alarm. With --repair "
      "the new "
      "record takes the place of one whose bytes are damaged (fracfarm verify finds those).",
      "fracfarm recheck"};
  add_farm_options(app, options);
  app.add_option("JOB", jobs, "ids, or the first characters of keys").required();
  app.add_flag("--repair", repair, "keep the new record's bytes");
  app.add_flag("--dry-run", dry_run, "say what would be computed again, change nothing");
  if (const auto status = app.parse(argc, argv)) return *status;
  return change(options, "recheck", {{"jobs", jobs}, {"repair", repair}, {"dry_run", dry_run}}, {"to be computed again:", " job", "s"});
}

}  // namespace fracfarm::cli
