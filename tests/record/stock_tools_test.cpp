// The readers that people have must open a record as it is: h5py, ncdump, h5dump and ParaView. A tool that is not installed is skipped in
// words.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <utility>

#include "common/record/writer.hpp"
#include "tests/record/sample_fdem.hpp"
#include "tests/record/sample_record.hpp"
#include "tests/record/temporary_folder.hpp"

using namespace fracfarm;

namespace {

constexpr int not_here = 77, no_such_command = 127;

// Exit status and everything that it printed.
std::pair<int, std::string> run(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::string text;
  char buffer[4096];
  while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, got);
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}

struct Written {
  test::TemporaryFolder folder;
  Record record = as_stored(sample::record({31, 23, 7, 50}));
  std::string path = folder.path() / "record.h5";

  Written() { write_record(record, path, Keeping::scratch).value(); }
  std::string expected() const {
    const std::vector<float>& last = record.phase_field.psi.back();
    return fmt::format("{} {} {:.17g} {:.9g} {:.9g}", path, record.phase_field.time.size(), record.phase_field.time.back(),
                       *std::max_element(last.begin(), last.end()),
                       std::accumulate(last.begin(), last.end(), 0.0) / static_cast<double>(last.size()));
  }
};

struct WrittenMesh {
  test::TemporaryFolder folder;
  Record record = as_stored(sample::fdem_record());
  std::string path = folder.path() / "record.h5";

  WrittenMesh() { write_record(record, path, Keeping::scratch).value(); }
  const std::vector<float>& last() const { return record.fdem.damage.back(); }
  long count(float damage) const { return std::count(last().begin(), last().end(), damage); }
};

bool skipped(int status, const std::string& text, const char* tool) {
  if (status != not_here && status != no_such_command) return false;
  WARN(tool << " is not installed: " << text);
  return true;
}

std::string helper(const char* name) { return fmt::format("{}/tests/record/{}", FRACFARM_SOURCE_DIR, name); }

// The first python3 on a PATH may lack the module: probe by import, then take the system's.
std::string python_with(const char* module) {
  return run(fmt::format("python3 -c 'import {}'", module)).first == 0 ? "python3" : "/usr/bin/python3";
}

}  // namespace

TEST_CASE("stock h5py reads a record") {
  const Written written;
  const auto [status, text] = run(fmt::format("{} {} {}", python_with("h5py"), helper("stock_h5py.py"), written.expected()));
  if (skipped(status, text, "h5py")) return;
  INFO(text);
  CHECK(status == 0);
}

TEST_CASE("ncdump sees coordinates, dimensions and units") {
  const Written written;
  const auto [status, text] = run("ncdump -h " + written.path);
  if (skipped(status, text, "ncdump")) return;
  INFO(text);
  REQUIRE(status == 0);
  for (const char* line : {"time = 7 ;", "z = 24 ;", "x = 32 ;", "float psi(time, z, x) ;", "double time(time) ;", "time:units = \"s\" ;",
                           "psi:units = \"1\" ;", "byte mask_initial(z, x) ;", ":Conventions = \"CF-1.10\" ;",
                           "double kinetic_energy(step_time) ;", ":chosen_rule = \"through_crack\" ;"})
    CHECK(text.find(line) != std::string::npos);
}

TEST_CASE("ncdump prints the numbers that were written") {
  const Written written;
  const auto [status, text] = run("ncdump -p 9,17 -v time " + written.path);
  if (skipped(status, text, "ncdump")) return;
  CHECK(text.find("time = 0, 5") != std::string::npos);
  const auto [all, everything] = run("ncdump " + written.path);  // every value of every group
  CHECK(all == 0);
  CHECK(everything.find("\"through_crack\"") != std::string::npos);
}

TEST_CASE("h5dump reads every dataset through the stock filters") {
  const Written written;
  const auto [status, text] = run("h5dump " + written.path);
  if (skipped(status, text, "h5dump")) return;
  CHECK(status == 0);
  CHECK(text.find("DATASET \"psi_failure\"") != std::string::npos);
  CHECK(text.find("h5dump error") == std::string::npos);
  const auto [filters, layout] = run("h5dump -p -H -d /psi " + written.path);
  for (const char* word : {"PREPROCESSING SHUFFLE", "COMPRESSION DEFLATE", "CHECKSUM FLETCHER32"})
    CHECK(layout.find(word) != std::string::npos);
}

TEST_CASE("ParaView opens a record as a time series") {
  const Written written;
  const auto [status, text] = run(fmt::format("pvpython {} {}", helper("stock_paraview.py"), written.expected()));
  if (skipped(status, text, "pvpython")) return;
  INFO(text);
  CHECK(status == 0);
}

TEST_CASE("stock h5py reads an FDEM record and makes a table of edges of it") {
  const WrittenMesh written;
  const auto [status, text] =
      run(fmt::format("{} {} {} {} {} {} {} {}", python_with("h5py"), helper("stock_h5py_fdem.py"), written.path,
                      written.record.fdem.time.size(), written.last().size(), written.count(2.0f), written.count(1.0f), 0.25 * 0.2));
  if (skipped(status, text, "h5py")) return;
  INFO(text);
  CHECK(status == 0);
}

TEST_CASE("ncdump sees the mesh, its edges and their damage over time") {
  const WrittenMesh written;
  const auto [status, text] = run("ncdump -h " + written.path);
  if (skipped(status, text, "ncdump")) return;
  INFO(text);
  REQUIRE(status == 0);
  for (const char* line :
       {"time = 9 ;", "float damage(time, edge) ;", "double break_time(edge) ;", "byte edge_kind(edge) ;", "int edge(edge) ;",
        "int tri_nodes(", "double node_xyz(", "break_time:units = \"s\" ;", "double friction_energy(step_time) ;"})
    CHECK(text.find(line) != std::string::npos);
  CHECK(run("ncdump " + written.path).first == 0);  // every value of every group
}

TEST_CASE("h5dump reads every dataset of an FDEM record through the stock filters") {
  const WrittenMesh written;
  const auto [status, text] = run("h5dump " + written.path);
  if (skipped(status, text, "h5dump")) return;
  CHECK(status == 0);
  CHECK(text.find("DATASET \"edge_tris\"") != std::string::npos);
  CHECK(text.find("h5dump error") == std::string::npos);
}

TEST_CASE("ParaView opens an FDEM record as a time series") {
  const WrittenMesh written;
  const auto& last = written.last();
  const auto [status, text] = run(fmt::format("pvpython {} {} {} {:.17g} {} {:.9g}", helper("stock_paraview_fdem.py"), written.path,
                                              written.record.fdem.time.size(), written.record.fdem.time.back(), last.size(),
                                              std::accumulate(last.begin(), last.end(), 0.0) / static_cast<double>(last.size())));
  if (skipped(status, text, "pvpython")) return;
  INFO(text);
  CHECK(status == 0);
}
