// The house rules against the whole tree, and each rule against a bad file, so that none of them can fall asleep.
#include <catch2/catch.hpp>

#include <filesystem>

#include "tests/tidy/rules.hpp"

using namespace tidy;

namespace {

const Tree& project() {
  static const Tree tree = read_tree(FRACFARM_SOURCE_DIR);
  return tree;
}

std::string file_of_project(const std::string& path) {
  for (const SourceFile& file : project())
    if (file.path == path) return file.text;
  FAIL("no file " << path);
  return {};
}

void expect_none(const Violations& violations) {
  INFO(violations.size() << " violations:\n" << text_of(violations));
  CHECK(violations.empty());
}

// What the rule says of one file.
std::string includes(const std::string& path, const std::string& text) { return text_of(check_includes({{path, text}})); }
std::string text_rule(const std::string& path, const std::string& text) { return text_of(check_text({{path, text}})); }

std::string repeated(const std::string& line, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += line;
  return text;
}

bool says(const std::string& text, const std::string& piece) {
  INFO(text);
  CHECK(text.find(piece) != std::string::npos);
  return text.find(piece) != std::string::npos;
}

}  // namespace

TEST_CASE("the tree is there") {
  CHECK(project().size() > 100);
  file_of_project("common/base/result.hpp");
  file_of_project("CMakeLists.txt");
}

TEST_CASE("the project keeps its include rules") { expect_none(check_includes(project())); }
TEST_CASE("no file grows past its limit") { expect_none(check_file_lengths(project(), file_of_project("tests/tidy/long_files.txt"))); }
TEST_CASE("no function grows past its limit") {
  expect_none(check_function_lengths(project(), file_of_project("tests/tidy/long_functions.txt")));
}
TEST_CASE("no file is an orphan and no test is in no target") { expect_none(check_targets(project())); }
TEST_CASE("the text of the project is clean") { expect_none(check_text(project())); }

TEST_CASE("a room that includes what it may not see is named with its line") {
  says(includes("common/base/x.cpp", "\n#include \"common/scene/scene.hpp\"\n"),
       "common/base/x.cpp:2: common/base may not include common/scene/scene.hpp");
  says(includes("solver/phasefield/x.cpp", "#include \"solver/fdem/y.hpp\"\n"), "may not include");
  says(includes("solver/grid.cpp", "#include \"common/record/record.hpp\"\n"), "may not include");
  says(includes("solver/phasefield/x.cpp", "#include \"common/wire/codec.hpp\"\n"), "may not include");
  says(includes("worker/x.cpp", "#include \"coordinator/ledger.hpp\"\n"), "may not include");
  says(includes("coordinator/x.cpp", "#include \"tests/fake.hpp\"\n"), "may not include");
  says(includes("solver/law/x.hpp", "#include \"common/base/result.hpp\"\n"), "may not include");
  says(includes("elsewhere/x.cpp", ""), "belongs to no room");
  says(includes("worker/x.cpp", "#include \"session.hpp\"\n"), "path from the top");
}

TEST_CASE("what the table allows is allowed") {
  CHECK(includes("solver/program/x.cpp", "#include \"common/record/record.hpp\"\n").empty());
  CHECK(includes("solver/phasefield/x.cpp", "#include \"solver/law/y.hpp\"\n#include \"common/scene/scene.hpp\"\n").empty());
  CHECK(includes("coordinator/cli/x.cpp", "#include \"coordinator/campaign.hpp\"\n").empty());
  CHECK(includes("common/scene/x.cpp", "#include \"common/scene/y.hpp\"\n#include <vector>\n").empty());
  CHECK(includes("solver/law/x.hpp", "#include <cmath>\n").empty());
}

TEST_CASE("a library outside its room is named") {
  says(includes("worker/x.cpp", "#include <hdf5.h>\n"), "go through common/record");
  says(includes("worker/x.cpp", "#include <zmq.hpp>\n"), "go through common/wire");
  says(includes("coordinator/queries.cpp", "#include <sqlite3.h>\n"), "go through coordinator/ledger*");
  says(includes("solver/law/x.hpp", "#include <vector>\n"), "<cmath> alone");
  says(includes("common/scene/x.hpp", "#include <nlohmann/json.hpp>\n"), "json_fwd");
  CHECK(includes("common/record/x.cpp", "#include <hdf5.h>\n").empty());
  CHECK(includes("coordinator/ledger_sqlite.cpp", "#include <sqlite3.h>\n").empty());
}

TEST_CASE("a file past 400 lines is named, and a listed one may only shrink") {
  const Tree tree{{"worker/x.cpp", repeated("\n", 410)}};
  says(text_of(check_file_lengths(tree, "")), "file of 410 lines, at most 400");
  CHECK(check_file_lengths(tree, "# old\nworker/x.cpp 410\n").empty());
  says(text_of(check_file_lengths(tree, "worker/x.cpp 405\n")), "at most 405");
  says(text_of(check_file_lengths(tree, "worker/x.cpp 415\n")), "has shrunk from 415");
  says(text_of(check_file_lengths({{"worker/y.cpp", ""}}, "worker/x.cpp 415\n")), "remove its row");
}

TEST_CASE("a function past 60 lines is named, wherever it stands") {
  const std::string body = "{\n" + repeated("  call();\n", 61) + "}\n";
  for (const std::string head :
       {"void grow(int a) ", "namespace a {\nint B::grow(const T& x) const noexcept ", "struct S {\n  auto grow() -> int ",
        "S::grow(int a) : a_(a), b_{a}, c_{{a}} ", "template <class T>\nT grow(T (&x)[3]) ",
        "std::map<int, std::function<void(int)>>& grow() ", "namespace {\nconst char* brace = \"{\";  // {\nvoid grow() "})
    says(text_of(check_function_lengths({{"worker/x.cpp", head + body}}, "")), "grow: function of 6");
  CHECK(check_function_lengths({{"worker/x.cpp", "void fine() {\n" + repeated("  call();\n", 58) + "}\n"}}, "").empty());
  CHECK(check_function_lengths({{"worker/x.cpp", "constexpr Row table[] = {\n" + repeated("  {1, call(2)},\n", 90) + "};\n"}}, "").empty());
  CHECK(check_function_lengths({{"worker/x.cpp", "void a() {}\n" + repeated("void b() { if (x) { y(); } }\n", 90)}}, "").empty());
  CHECK(check_function_lengths({{"worker/x.cpp", "void grow() " + body}}, "worker/x.cpp:grow 63\n").empty());
}

TEST_CASE("a source or test in no target is named") {
  const SourceFile top{"CMakeLists.txt", "add_subdirectory(worker)\nadd_subdirectory(tests)\n"};
  const SourceFile worker{"worker/CMakeLists.txt", "# y.cpp is gone\nfracfarm_room(worker SOURCES x.cpp LINKS z)\n"};
  const SourceFile tests{"tests/CMakeLists.txt", "fracfarm_tests(t SOURCES x_test.cpp)\nadd_executable(helper z_test.cpp)\n"};
  const auto rule = [&](SourceFile extra) { return text_of(check_targets({top, worker, tests, std::move(extra)})); };
  CHECK(rule({"worker/x.cpp", ""}).empty());
  CHECK(rule({"tests/x_test.cpp", ""}).empty());
  says(rule({"worker/y.cpp", ""}), "worker/y.cpp: is in no target of worker/CMakeLists.txt: an orphan");
  says(rule({"tests/y_test.cpp", ""}), "a test that never runs");
  says(rule({"tests/z_test.cpp", ""}), "in no fracfarm_tests row");
  says(rule({"solver/y.cpp", ""}), "no CMakeLists.txt builds it");
  says(rule({"solver/CMakeLists.txt", ""}), "is not reached by add_subdirectory(solver)");
  says(rule({"worker/y.hpp", ""}), "included by nobody");
}

TEST_CASE("long lines, tabs, loose ends and missing openings are named") {
  says(text_rule("a.cpp", std::string(161, 'x') + "\n"), "161 columns");
  CHECK(text_rule("a.cpp", "// " + repeated("\xc3\xa9", 150) + "\n").empty());
  says(text_rule("a.cpp", "\tx\n"), "a tab");
  says(text_rule("a.cpp", "x\r\n"), "carriage return");
  says(text_rule("a.cpp", "x"), "does not end with a line break");
  says(text_rule("a.hpp", "#pragma once\n"), "opens without a comment");
  says(text_rule("a.hpp", "// What.\n#include <x>\n"), "#pragma once must follow");
  CHECK(text_rule("a.hpp", "// What.\n#pragma once\n").empty());
}

TEST_CASE("words that must not stand in the project are named") {
  says(text_rule("a.cpp",
                 "// FIX"
                 "ME later\n"),
       "finish it");
  says(text_rule("a.cpp",
                 "// TO"
                 "DO: x\n"),
       "finish it");
  says(text_rule("a.sh",
                 "cd /ro"
                 "ot/x\n"),
       "a path of one machine");
  says(text_rule("a.cpp",
                 "open(\"/wo"
                 "rk/main\")\n"),
       "a path of one machine");
  says(text_rule("CMakeLists.txt",
                 "add_compile_options(-ff"
                 "ast-math)\n"),
       "same bits");
  says(text_rule("a.cpp",
                 "int x = ra"
                 "nd();\n"),
       "RandomStream");
  says(text_rule("common/a.cpp",
                 "std::co"
                 "ut << 1;\n"),
       "print nothing");
  CHECK(text_rule("a.cpp",
                  "see coordinator/wo"
                  "rk/x and operand(); // method\n")
            .empty());
}

TEST_CASE("comments and strings are no code") {
  CHECK(only_code("a /*{*/ b \"{\\\"\" c '{' 1'000 // {\nd") == "a       b       c     1'000     \nd");
  CHECK(only_code("x R\"y({\")y\" z") == "x           z");
}
