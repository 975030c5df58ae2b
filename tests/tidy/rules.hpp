// The house rules that a machine can see. Each is a pure function of files in memory, so that its own test can show it a bad one.
#pragma once

#include "tests/tidy/source_tree.hpp"

namespace tidy {

// include_rules.cpp: who may include whom (the one table of it), and which room alone sees a library.
Violations check_includes(const Tree& tree);

// length_rules.cpp: files to 400 lines, functions to 60. What was longer once is listed with its length, and may only shrink.
Violations check_file_lengths(const Tree& tree, std::string_view exceptions);
Violations check_function_lengths(const Tree& tree, std::string_view exceptions);

// target_rules.cpp: every .cpp is built by the CMakeLists.txt of its folder (tests by a fracfarm_tests row), every such file is reached
// from the top, every header is included by somebody.
Violations check_targets(const Tree& tree);

// text_rules.cpp: columns, tabs, ends of files, opening comments, and words that must not stand in the project.
Violations check_text(const Tree& tree);

}  // namespace tidy
