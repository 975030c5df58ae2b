// What a person sees: colour only on a terminal (NO_COLOR respected), aligned tables, one progress line that rewrites itself.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace fracfarm {

enum class Ink { plain, bold, dim, red, green, yellow, blue };

bool is_terminal(std::FILE* stream);
// Wrapped in colour codes where the stream is a terminal and NO_COLOR is not set; else the text as it is.
std::string ink(std::string_view text, Ink colour, std::FILE* stream);

// Rows of cells as aligned columns; the first row is the heading. Columns whose cells all look like numbers align right.
std::string table_text(const std::vector<std::vector<std::string>>& rows);

// One line that is rewritten on a terminal; without one, a plain line at most every `quiet_interval_s`, and the last.
class ProgressLine {
 public:
  explicit ProgressLine(std::FILE* stream = stderr, double quiet_interval_s = 60.0);
  ~ProgressLine();
  void show(const std::string& line);
  void finish(const std::string& line);  // prints it for good

 private:
  std::FILE* stream_;
  bool terminal_;
  double quiet_interval_s_;
  double last_s_ = -1e300;
  bool open_ = false;
};

}  // namespace fracfarm
