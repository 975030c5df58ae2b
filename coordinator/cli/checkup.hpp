// Is this machine fit to serve a farm or to work for it? Each check looks, and says what it found, what it wants and what to do.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fracfarm::cli {

struct CheckupLine {
  enum class Verdict { good, warning, bad } verdict = Verdict::good;
  std::string name;
  std::string found;
  std::string advice;  // empty where it is good
};
std::string_view word_of(CheckupLine::Verdict verdict);  // good, warning, bad

std::vector<CheckupLine> check_up(const std::filesystem::path& farm);

// Single checks, for tests: what is measured comes in.
CheckupLine judge_disk(const std::string& name, double free_bytes, double free_inodes, double inodes);
CheckupLine judge_file_limit(double most_files);
CheckupLine judge_clock(bool synchronized, double error_s);
CheckupLine judge_key(const std::filesystem::path& file, unsigned mode);

}  // namespace fracfarm::cli
