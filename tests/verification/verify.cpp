// fracfarm-verify: runs the benchmark rows and prints them as text, Markdown or JSON. Ends with status 1 where a row misses.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "common/base/atomic_file.hpp"
#include "common/base/clock.hpp"
#include "common/base/exit_code.hpp"
#include "tests/verification/report.hpp"

namespace fracfarm::verification {
namespace {

struct Options {
  bool all = false, json = false, markdown = false;
  std::string pictures;
  std::vector<std::string> ids;
};

bool wanted(const Case& one, const Options& options) {
  if (options.ids.empty()) return options.all || !one.is_long;
  return std::find(options.ids.begin(), options.ids.end(), one.id) != options.ids.end();
}

std::vector<Done> run(const Options& options) {
  SystemClock clock;
  std::vector<Done> done;
  for (const Case& one : cases()) {
    if (!wanted(one, options)) continue;
    Desk desk(one.id);
    const double begin = clock.monotonic_s();
    std::vector<Row> rows = one.run(desk);
    done.push_back({&one, std::move(rows), desk.pictures(), clock.monotonic_s() - begin});
  }
  return done;
}

Result<void> write_pictures(const std::vector<Done>& done, const std::filesystem::path& folder) {
  std::error_code ignored;  // a folder that is not there makes the first file fail, which says so
  std::filesystem::create_directories(folder, ignored);
  for (const Done& one : done)
    for (const Picture& picture : one.pictures)
      if (auto written = write_atomically(folder / (picture.name + ".png"), picture::png_bytes(picture.canvas)); !written) return written;
  return {};
}

std::vector<std::string> known_ids() {
  std::vector<std::string> ids;
  for (const Case& one : cases())
    if (std::find(ids.begin(), ids.end(), one.id) == ids.end()) ids.emplace_back(one.id);
  return ids;
}

}  // namespace
}  // namespace fracfarm::verification

int main(int argc, char** argv) {
  using namespace fracfarm::verification;
  Options options;
  CLI::App app{"Benchmarks with known answers: target, ours, error. Ends with status 1 where a row misses."};
  app.add_flag("--long", options.all, "the long cases too, minutes in all; alone, only the fast ones run");
  auto* json = app.add_flag("--json", options.json, "one JSON object");
  app.add_flag("--markdown", options.markdown, "the page VERIFICATION.md")->excludes(json);
  app.add_option("--pictures", options.pictures, "folder for the plots, which --markdown links to");
  app.add_option("ID", options.ids, "only these cases, fast or long")->check(CLI::IsMember(known_ids()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? fracfarm::exit_ok : fracfarm::exit_bad_input;
  }
  const std::vector<Done> done = run(options);
  fmt::print("{}", options.json ? json_report(done) : options.markdown ? page_report(done, options.pictures) : text_report(done));
  if (!options.pictures.empty())
    if (auto written = write_pictures(done, options.pictures); !written) {
      fmt::print(stderr, "fracfarm-verify: {}\n", written.error().message);
      return fracfarm::exit_failed;
    }
  const bool passed = std::all_of(done.begin(), done.end(), [](const Done& one) { return one.passed(); });
  return passed ? fracfarm::exit_ok : fracfarm::exit_failed;
}
