#include <algorithm>
#include <array>
#include <regex>

#include "tests/tidy/rules.hpp"

namespace tidy {
namespace {

// A room and the folders that it may include besides itself; the first row that holds a file counts. "x/" means x and everything below.
struct Room {
  std::string_view folder;
  std::vector<std::string_view> sees;
};

const std::vector<Room>& rooms() {
  static const std::vector<Room> table{
      {"common/base", {}},
      {"common/material", {"common/base"}},
      {"common/failure", {"common/base"}},
      {"common/scene", {"common/base", "common/material"}},
      {"common/record", {"common/base", "common/material", "common/scene", "common/failure"}},
      {"common/picture", {"common/base", "common/material", "common/scene", "common/failure", "common/record"}},
      {"common/task", {"common/base", "common/failure"}},
      {"common/wire", {"common/base", "common/failure"}},
      {"solver/law", {}},
      {"solver/program", {"solver", "solver/fdem/mesh", "common/"}},
      {"solver/phasefield", {"solver", "solver/law", "common/base", "common/material", "common/scene", "common/failure"}},
      {"solver/fdem", {"solver", "solver/law", "common/base", "common/material", "common/scene", "common/failure"}},
      {"solver", {"solver/law", "solver/phasefield", "solver/fdem", "common/base", "common/material", "common/scene", "common/failure"}},
      {"worker/program", {"worker", "common/"}},
      {"worker", {"common/"}},
      {"coordinator/program", {"coordinator", "common/"}},
      {"coordinator/cli", {"coordinator", "common/"}},
      {"coordinator", {"common/"}},
      {"tests", {"tests/", "common/", "solver/", "worker/", "coordinator/"}},
  };
  return table;
}

// A library and where alone its headers may be included; files are matched by the beginning of their path.
struct Library {
  std::string_view header;  // the beginning of what stands between the angle brackets
  std::vector<std::string_view> where;
  std::string_view instead;
};

const std::vector<Library>& libraries() {
  static const std::vector<Library> table{
      {"hdf5", {"common/record/", "tests/record/"}, "go through common/record"},
      {"zmq", {"common/wire/", "tests/wire/", "tests/operators/hostile_farm"}, "go through common/wire"},
      {"sqlite3.h", {"coordinator/ledger", "tests/coordinator/ledger", "tests/simulation/fault_"}, "go through coordinator/ledger*"},
      {"toml++", {"coordinator/campaign"}, "go through coordinator/campaign*"},
      {"Random123", {"common/base/"}, "use RandomStream"},
      {"catch2", {"tests/"}, "tests belong in tests"},
  };
  return table;
}

const Room* room_of(const SourceFile& file) {
  for (const Room& room : rooms())
    if (file.under(room.folder)) return &room;
  return nullptr;
}

bool may_see(const Room& room, std::string_view target) {
  const std::string folder = std::filesystem::path(target).parent_path().string();
  const auto covers = [&](std::string_view seen) { return seen.ends_with('/') ? (folder + "/").starts_with(seen) : folder == seen; };
  return (folder + "/").starts_with(std::string(room.folder) + "/") || std::any_of(room.sees.begin(), room.sees.end(), covers);
}

void check_own(const SourceFile& file, const Room& room, std::size_t line, const std::string& target, Violations& out) {
  if (target.find('/') == std::string::npos || target.starts_with(".")) {
    if (target.find("build_info") == std::string::npos)
      out.push_back({file.path, line, "includes \"" + target + "\": write the path from the top of the project"});
  } else if (!may_see(room, target)) {
    out.push_back({file.path, line, std::string(room.folder) + " may not include " + target + " (table in tests/tidy/include_rules.cpp)"});
  }
}

void check_library(const SourceFile& file, std::size_t line, const std::string& header, Violations& out) {
  if (file.under("solver/law") && header != "cmath")
    out.push_back({file.path, line, "solver/law may include <cmath> alone, not <" + header + ">"});
  if (header == "nlohmann/json.hpp" && file.ends_with(".hpp") && !file.under("tests"))
    out.push_back(
        {file.path, line, "<nlohmann/json.hpp> is slow to compile: include it in .cpp files, <nlohmann/json_fwd.hpp> in headers"});
  for (const Library& library : libraries()) {
    const auto holds = [&](std::string_view place) { return file.path.starts_with(place); };
    if (header.starts_with(library.header) && std::none_of(library.where.begin(), library.where.end(), holds))
      out.push_back({file.path, line, "may not include <" + header + ">: " + std::string(library.instead)});
  }
}

}  // namespace

Violations check_includes(const Tree& tree) {
  static const std::regex include(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  Violations out;
  for (const SourceFile& file : tree) {
    if (!file.code()) continue;
    const Room* room = room_of(file);
    if (!room) {
      out.push_back({file.path, 0, "belongs to no room of the table in tests/tidy/include_rules.cpp"});
      continue;
    }
    std::size_t number = 0;
    for (const std::string_view line : lines_of(file.text)) {
      ++number;
      std::match_results<std::string_view::const_iterator> found;
      if (!std::regex_search(line.begin(), line.end(), found, include)) continue;
      found[1] == "\"" ? check_own(file, *room, number, found[2], out) : check_library(file, number, found[2], out);
    }
  }
  return out;
}

}  // namespace tidy
