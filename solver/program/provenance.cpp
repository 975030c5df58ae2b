#include "solver/program/provenance.hpp"

#include <sys/resource.h>

#include <fstream>

#include "common/base/build_info.hpp"
#include "common/base/clock.hpp"
#include "common/base/text.hpp"
#include "common/scene/parse.hpp"

namespace fracfarm {
namespace {

constexpr std::size_t text_limit = 2000;  // characters of one entry

std::string read_cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

const std::string& cpu_model() {
  static const std::string model = read_cpu_model();  // once for all jobs of a child
  return model;
}

std::string peak_memory_bytes() {
  struct rusage usage {};
  ::getrusage(RUSAGE_SELF, &usage);
  return std::to_string(static_cast<long long>(usage.ru_maxrss) * 1024);
}

// Records hold printable ASCII only.
std::string printable(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text.substr(0, text_limit);
}

std::string warnings_text(const Scene& scene) {
  std::string text;
  for (const std::string& warning : scene_warnings(scene)) text += (text.empty() ? "" : "; ") + warning;
  return text.empty() ? "none" : text;
}

std::string notes_text(const RunResult& result) {
  std::string text;
  for (const std::string& note : result.notes) text += (text.empty() ? "" : "; ") + note;
  return text.empty() ? "none" : text;
}

std::string stages_text(const RunResult& result) {
  std::string text;
  for (const auto& [stage, seconds] : result.stages) text += (text.empty() ? "" : " ") + stage + "=" + shortest(seconds);
  return text;
}

}  // namespace

std::map<std::string, std::string> provenance_of(const Scene& scene, const RunResult& result, const AttemptInfo& attempt) {
  const BuildInfo& build = build_info();
  std::map<std::string, std::string> entries{
      {"build_id", build.build_id},
      {"compiler", build.compiler},
      {"flags", build.flags},
      {"cpu", cpu_model()},
      {"hdf5_version", FRACFARM_HDF5_VERSION},
      {"cpu_s", shortest(result.cpu_s)},
      {"wall_s", shortest(result.wall_s)},
      {"peak_memory_bytes", peak_memory_bytes()},
      {"attempt", std::to_string(attempt.attempt)},
      {"step_scale", shortest(attempt.step_scale)},
      {"kernel", result.kernel},
      {"steps", std::to_string(result.steps)},
      {"dt", shortest(result.dt)},
      {"stages_s", stages_text(result)},
      {"warnings", warnings_text(scene)},
      {"notes", notes_text(result)},
      {"written", utc_text(SystemClock{}.wall_s())},
  };
  for (auto& [name, text] : entries) text = printable(text);
  return entries;
}

}  // namespace fracfarm
